#pragma once
#include <gtest/gtest.h>

#include <exception>

/** The N-th `new` from now fails, counted from 0, whichever thread it is on; below 0: none does.
 * For tests that link failing_allocations. */
void failAllocation(long n);
/** Whether the one that was to fail last came. */
bool hasAllocationFailed();

/** Fails the first, the second, ... allocation of an operation, until none is left to fail.
 * \param prepare called before each \param afterFailure called after each that failed
 * \return how often it failed */
template <typename Prepare, typename Operation, typename Check>
int failEachAllocation(const Prepare& prepare, const Operation& operation,
                       const Check& afterFailure) {
  for (int n = 0, failures = 0;; ++n) {
    bool failed = false;
    prepare();
    failAllocation(n);
    try {
      operation();
    } catch (const std::exception&) {
      failed = true;
    }
    failAllocation(-1);
    if (failed) ++failures, afterFailure();  // sorting does without
    if (!hasAllocationFailed() || testing::Test::HasFailure()) {
      EXPECT_FALSE(failed) << "when allocation " << n << " had failed";
      return failures;
    }
  }
}
