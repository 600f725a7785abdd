#pragma once
#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <thread>

/** Waits in a thread of its own for the signals that tell a program to end (SIGINT, SIGTERM,
 * SIGHUP). Then the program leaves and removes its unfinished outputs (leaveWithoutOutputs()), or a
 * StopRequest tells it. SIGPIPE and SIGXFSZ are ignored: writing fails, which is an error like
 * others. */
class SignalWatch {
 public:
  /** \param program Its name, for messages. */
  explicit SignalWatch(std::string program);
  ~SignalWatch();

  /** The signal that asked the program to stop early, or 0. */
  static int stoppedBy();

 private:
  void watch();
  void act(int signal);
  void say(const std::string& what) const;

  std::string m_program;
  std::thread m_thread;
};

/** What a program throws that was asked to stop before it had anything to write: its exit status is
 * that of being stopped. */
class StoppedTooEarly : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** Lets a program stop before its end and keep what it has. While this lives, the first SIGINT or
 * SIGTERM asks for that; the next one ends the program at once. */
class StopRequest {
 public:
  /** \param when What the user is told: "after this observation" */
  explicit StopRequest(std::string when);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /** Whether it was asked for. */
  bool pending() const;
};

/** What a program says of its own accord: the standard output, in place of the bar of Progress, or
 * nothing after beQuiet(). What it was asked for goes to std::cout. */
std::ostream& notes();
/** Details that most do not want to know; says nothing unless beVerbose() was called. */
std::ostream& details();
void beQuiet();
void beVerbose();

/** Gives the standard streams that are closed a descriptor that takes nothing: otherwise the first
 * file that is opened would get what is printed. From then on std::cout and std::cerr show control
 * characters, which names in files may have, as printable() does; lines and tabs stay. */
void openStandardStreams();

/** \return whether all that was printed was taken */
bool flushStandardOutput();

/** Says how far a task is: on a terminal a bar with the time that is left, elsewhere a line every
 * five seconds. */
class Progress {
 public:
  /** \param task what is done, "Mapping" \param total of what update() gets; 0: nobody knows */
  Progress(std::string task, std::uint64_t total);
  /** The bar is gone. */
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /** \param note short, "12 scans" */
  void update(std::uint64_t done, const std::string& note);

 private:
  using Clock = std::chrono::steady_clock;

  std::string m_task;
  std::uint64_t m_total;
  bool m_onTerminal;
  Clock::time_point m_began = Clock::now(), m_said;
};
