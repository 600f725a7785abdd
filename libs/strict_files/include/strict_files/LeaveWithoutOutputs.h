#pragma once

namespace strict_files {

/** Ends the process at once, as _exit() does, after all files and folders are removed that it has
 * begun (StagedFile, OutputFolder) and that have not taken their place. For programs that are told
 * to leave; any thread may call it, but no handler of a signal. */
[[noreturn]] void leaveWithoutOutputs(int status);

}  // namespace strict_files
