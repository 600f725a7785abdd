#include <strict_files/Memory.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

namespace strict_files {

AllocationLimit::Allows*& AllocationLimit::current() {
  thread_local Allows* limit = nullptr;
  return limit;
}

bool AllocationLimit::isAllowed(std::size_t bytes) {
  Allows* const limit = std::exchange(current(), nullptr);  // its own memory is not asked for
  if (!limit) return true;
  const bool isAllowed = bytes <= kMost && (*limit)(bytes);
  current() = limit;
  return isAllowed;
}

namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

std::uint64_t leftInSystem() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  std::uint64_t kibibytes = 0;
  while (file >> word)
    if (word == "MemAvailable:" && file >> kibibytes) return 1024 * kibibytes;
  return kNoLimit;
}

std::uint64_t leftToProcess() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoLimit;
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::uint64_t taken = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > taken ? limit.rlim_cur - taken : 0;
}

}  // namespace

std::uint64_t availableMemory() { return std::min(leftInSystem(), leftToProcess()); }

}  // namespace strict_files
