#include "FailingAllocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

/** Until one fails; below 0: none does. */
std::atomic<long> allocationsLeft{-1};
std::atomic<bool> hasFailed{false};

bool fails() {
  if (allocationsLeft.load(std::memory_order_relaxed) < 0) return false;
  const bool fails = allocationsLeft.fetch_sub(1) == 0;
  if (fails) hasFailed = true;
  return fails;
}

}  // namespace

void failAllocation(long n) {
  allocationsLeft = n;
  if (n >= 0) hasFailed = false;
}

bool hasAllocationFailed() { return hasFailed; }

// Not inline: or the compiler pairs malloc() here with delete there, and warns.
#define NOT_INLINE __attribute__((noinline))
NOT_INLINE void* operator new(std::size_t size) {
  void* memory = fails() ? nullptr : std::malloc(size);
  if (!memory) throw std::bad_alloc();
  return memory;
}
/** As the standard library's, but sanitizers have one that does not call the above. */
NOT_INLINE void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return fails() ? nullptr : std::malloc(size);
}
NOT_INLINE void operator delete(void* memory) noexcept { std::free(memory); }
NOT_INLINE void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
