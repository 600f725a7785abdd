#pragma once
#include <string>
#include <vector>

/** What came of a program of this project. */
struct ProgramRun {
  int status = -1;  ///< exit status
  std::string output, errors;
  long peakKilobytes = 0;  ///< most memory it ever held
};

/** Runs MSO_BIN_DIR/NAME (or a program of an absolute path) with these arguments, without a
 * terminal, and waits for its end. */
ProgramRun runProgram(const std::string& name, const std::vector<std::string>& arguments);
