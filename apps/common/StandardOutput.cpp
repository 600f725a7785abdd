#include "StandardOutput.h"

#include <fcntl.h>
#include <strict_files/Words.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <mutex>
#include <ostream>
#include <sstream>

namespace {

bool quiet = false, verbose = false;

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

std::ostream& notes() { return quiet ? nowhere() : std::cout; }
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

void replaceLine() {
  if (quiet || !isatty(STDOUT_FILENO)) return;
  std::cout.flush();
  std::fputs("\r\033[K", stdout);
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

Progress::~Progress() {
  if (m_isDrawn) replaceLine();
}

void Progress::update(std::uint64_t done, const std::string& note) {
  const Clock::time_point now = Clock::now();
  if (seconds(now - m_said) < (m_onTerminal ? kBetweenBars : kBetweenLines)) return;
  m_said = now;
  if (m_onTerminal) replaceLine();
  notes() << m_task << ": ";
  const double share =
      m_total == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(m_total));
  if (m_total > 0) notes() << shareText(share, m_onTerminal);
  notes() << note << timeLeft(seconds(now - m_began), share);
  if (m_onTerminal)
    notes() << std::flush;
  else
    notes() << std::endl;
  m_isDrawn = m_onTerminal;
}
