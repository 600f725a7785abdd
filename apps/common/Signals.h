#pragma once
#include <stdexcept>
#include <string>
#include <thread>

/** Waits in a thread of its own for the signals that tell a program to end (SIGINT, SIGTERM,
 * SIGHUP): it leaves, and takes its unfinished outputs along (leaveWithoutOutputs()), or is told by
 * a StopRequest. SIGPIPE and SIGXFSZ are ignored: writing fails, which is an error like others. */
class SignalWatch {
 public:
  /** \param program Its name, for messages. */
  explicit SignalWatch(std::string program);
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

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

/** Lets a program stop before its end and keep what it has: while this lives, the first
 * SIGINT or SIGTERM asks for that, and the next one ends the program at once. */
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
