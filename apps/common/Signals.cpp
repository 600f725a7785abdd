#include "Signals.h"

#include <fcntl.h>
#include <strict_files/OutputFiles.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <mutex>
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
