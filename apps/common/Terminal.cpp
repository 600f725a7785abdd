#include "Terminal.h"

#include <fcntl.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/Words.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <mutex>
#include <ostream>
#include <sstream>
#include <system_error>

namespace {

constexpr int kEnding[] = {SIGINT, SIGTERM, SIGHUP};

int signalPipe[2];
pid_t owner;
std::atomic<int> stopSignal = 0;
std::mutex whenMutex;
std::string stopsWhen;  ///< empty: there is no StopRequest

/** Hands the signal to the thread. A child that was not given another program ends. */
void handle(int signal) {
  if (getpid() != owner) _exit(128 + signal);
  const int before = errno;
  const auto byte = static_cast<unsigned char>(signal);
  (void)!write(signalPipe[1], &byte, 1);
  errno = before;
}

void handleBy(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

bool isIgnored(int signal) {
  struct sigaction action = {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

}  // namespace

SignalWatch::SignalWatch(std::string program) : m_program(std::move(program)) {
  if (pipe2(signalPipe, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
  owner = getpid();
  m_thread = std::thread([this] { watch(); });
  for (const int signal : kEnding)
    if (signal != SIGHUP || !isIgnored(signal)) handleBy(signal, handle);  // nohup
  for (const int signal : {SIGPIPE, SIGXFSZ}) handleBy(signal, SIG_IGN);
}

SignalWatch::~SignalWatch() {
  for (const int signal : kEnding) handleBy(signal, SIG_DFL);
  const unsigned char end = 0;
  (void)!write(signalPipe[1], &end, 1);
  m_thread.join();
  for (const int descriptor : signalPipe) close(descriptor);
}

int SignalWatch::stoppedBy() { return stopSignal; }

void SignalWatch::watch() {
  unsigned char signal = 0;
  while (read(signalPipe[0], &signal, 1) == 1 && signal != 0) act(signal);
}

/** On a terminal, behind its "^C". */
void SignalWatch::say(const std::string& what) const {
  std::cerr << (isatty(STDERR_FILENO) ? "\n" : "") << m_program << ": " << what << std::endl;
}

void SignalWatch::act(int signal) {
  const std::lock_guard lock(whenMutex);
  if (stopsWhen.empty() || signal == SIGHUP || stopSignal != 0) {
    say("stopped, and nothing more is written");
    strict_files::leaveWithoutOutputs(128 + signal);
  }
  stopSignal = signal;
  say("will stop " + stopsWhen + " and write what is there; once more stops at once");
}

StopRequest::StopRequest(std::string when) {
  const std::lock_guard lock(whenMutex);
  stopsWhen = std::move(when);
}

StopRequest::~StopRequest() {
  const std::lock_guard lock(whenMutex);
  stopsWhen.clear();
}

bool StopRequest::pending() const { return stopSignal != 0; }

namespace {

bool quiet = false, verbose = false;
std::atomic<bool> barIsDrawn = false;

/** Stands before a stream's own buffer, and passes on what a terminal only shows. */
class ShownBuffer : public std::streambuf {
 public:
  explicit ShownBuffer(std::ostream& stream) : m_target(stream.rdbuf(this)) {}

 protected:
  int_type overflow(int_type c) override {
    const char letter = traits_type::to_char_type(c);
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    return xsputn(&letter, 1) == 1 ? c : traits_type::eof();
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    const std::lock_guard lock(m_mutex);
    for (std::streamsize i = 0; i < size; ++i) {
      const bool ends = text[i] == '\n' || text[i] == '\t';
      if (!ends) m_part += text[i];
      if (ends && !(pass() && m_target->sputc(text[i]) == text[i])) return i;
    }
    return size;
  }
  int sync() override {
    const std::lock_guard lock(m_mutex);
    return pass() ? m_target->pubsync() : -1;
  }

 private:
  bool pass() {
    const std::string shown = strict_files::printable(m_part);
    m_part.clear();
    const auto size = static_cast<std::streamsize>(shown.size());
    return m_target->sputn(shown.data(), size) == size;
  }

  std::streambuf* const m_target;
  std::mutex m_mutex;  ///< threads may print, too
  std::string m_part;  ///< letters that came since the last line, tab or flush
};

std::ostream& nowhere() {
  static std::ostream stream(nullptr);
  return stream;
}

}  // namespace

std::ostream& notes() {
  if (quiet) return nowhere();
  if (barIsDrawn.exchange(false)) {
    std::cout.flush();
    std::fputs("\r\033[K", stdout);
  }
  return std::cout;
}
std::ostream& details() { return verbose && !quiet ? std::cout : nowhere(); }
void beQuiet() { quiet = true; }
void beVerbose() { verbose = true; }

void openStandardStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) == -1)  // open() gives the lowest that is free
      (void)!open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  new ShownBuffer(std::cout);  // never deleted: the streams are flushed after everything else
  new ShownBuffer(std::cerr);
}

bool flushStandardOutput() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::cout.good();
}

namespace {

constexpr double kBetweenBars = 0.1, kBetweenLines = 5;  // s
/** Before, nobody waits, and the time that is left is a guess; s. */
constexpr double kWorthTelling = 2;
constexpr int kBarWidth = 30;

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

/** ", 1:05 left" */
std::string timeLeft(double secondsPassed, double share) {
  if (secondsPassed < kWorthTelling || share <= 0) return {};
  const long left = std::lround(secondsPassed * (1 - share) / share);
  std::ostringstream text;
  text << ", " << left / 60 << ':' << std::setw(2) << std::setfill('0') << left % 60 << " left";
  return text.str();
}

/** "[####....] 50 %, " */
std::string shareText(double share, bool withBar) {
  const int full = static_cast<int>(share * kBarWidth);
  const std::string bar = "[" + std::string(full, '#') + std::string(kBarWidth - full, '.') + "] ";
  return (withBar ? bar : "") + std::to_string(static_cast<int>(100 * share)) + " %, ";
}

}  // namespace

Progress::Progress(std::string task, std::uint64_t total)
    : m_task(std::move(task)),
      m_total(total),
      m_onTerminal(isatty(STDOUT_FILENO)),
      m_said(m_onTerminal ? Clock::time_point() : m_began) {}

Progress::~Progress() { notes(); }

void Progress::update(std::uint64_t done, const std::string& note) {
  const Clock::time_point now = Clock::now();
  if (seconds(now - m_said) < (m_onTerminal ? kBetweenBars : kBetweenLines)) return;
  m_said = now;
  const double share =
      m_total == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(m_total));
  std::string line = m_task + ": ";
  if (m_total > 0) line += shareText(share, m_onTerminal);
  line += note + timeLeft(seconds(now - m_began), share);
  notes() << line << (m_onTerminal ? "" : "\n") << std::flush;
  barIsDrawn = m_onTerminal && !quiet;
}
