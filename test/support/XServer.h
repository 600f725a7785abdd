#pragma once
#include <filesystem>
#include <initializer_list>
#include <string>

#include "BuiltPrograms.h"
#include "RunProgram.h"

/** The first of these programs of Debian that is not installed; empty if all are. */
inline std::string missingOf(std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (!std::filesystem::exists(std::string("/usr/bin/") + name)) return name;
  return {};
}

/** Runs a program with a screen of its own (it takes xvfb-run and xauth). */
inline ProgramRun runInX(const Words& command) {
  return runProgram("/usr/bin/xvfb-run", joined({"-a", "-s", "-screen 0 1280x900x24"}, command));
}

/** Whether programs were built with windows. */
inline bool hasWindows() { return missingLibraryOf("semantic-map-view").empty(); }

/** Skips the running test, saying so, where it cannot open windows and work with them. */
#define SKIP_WITHOUT_WINDOWS()                                                           \
  if (!hasWindows()) GTEST_SKIP() << "built without windows";                            \
  if (const std::string missing = missingOf({"xvfb-run", "xauth", "xdotool", "import"}); \
      !missing.empty())                                                                  \
  GTEST_SKIP() << "needs " << missing
