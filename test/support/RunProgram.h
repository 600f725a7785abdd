#pragma once
#include <string>
#include <vector>

#include "TemporaryFolder.h"

using Words = std::vector<std::string>;

inline Words joined(Words words, const Words& more, const Words& last = {}) {
  words.insert(words.end(), more.begin(), more.end());
  words.insert(words.end(), last.begin(), last.end());
  return words;
}

/** What came of a program of this project. */
struct ProgramRun {
  int status = -1;  ///< exit status; 128 and the signal's number after a crash
  std::string output, errors;
  long peakKilobytes = 0;  ///< most memory it ever held
};

/** Runs MSO_BIN_DIR/NAME (or a program of an absolute path) with these arguments, without a
 * terminal, and waits for its end. */
ProgramRun runProgram(const std::string& name, const Words& arguments);
/** Runs a shell's command; its errors are in its output. */
ProgramRun runCommand(const std::string& command);

/** Expects that it ended well. */
ProgramRun succeeded(ProgramRun run);
/** Expects that it failed with one line that holds all of these. */
void expectRefusal(const ProgramRun& run, const Words& parts);
