#include <strict_files/Memory.h>

namespace strict_files {

int& AllocationLimit::living() {
  thread_local int count = 0;
  return count;
}

}  // namespace strict_files
