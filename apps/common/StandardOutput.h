#pragma once
#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <string>

/** What a program says of its own accord: the standard output, or nothing after beQuiet(). What it
 * was asked for goes to std::cout. */
std::ostream& notes();
/** Details that most do not want to know; says nothing unless beVerbose() was called. */
std::ostream& details();
void beQuiet();
void beVerbose();

/** On a terminal: what notes() says next replaces the line that was begun. */
void replaceLine();

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
  bool m_onTerminal, m_isDrawn = false;
  Clock::time_point m_began = Clock::now(), m_said;
};
