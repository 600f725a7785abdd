#pragma once
#include <cstdint>

namespace strict_files {

/** Bytes of memory that this process could still take: what the system has left, and no more than
 * the limit on its addresses (`ulimit -v`). Without /proc/meminfo only the latter counts. */
std::uint64_t availableMemory();

}  // namespace strict_files
