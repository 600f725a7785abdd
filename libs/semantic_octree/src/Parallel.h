#pragma once
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace semantic_octree {

/** Calls work(0) to work(n - 1), all but the first in threads of their own, and waits for all.
 * What cannot get a thread is done by the caller. The first exception is thrown again. */
template <typename F>
void inParallel(int n, const F& work) {
  std::exception_ptr failure;
  std::mutex mutex;
  const auto guarded = [&](int i) {
    try {
      work(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  helpers.reserve(static_cast<std::size_t>(n));
  int started = 1;
  try {
    for (; started < n; ++started) helpers.emplace_back(guarded, started);
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
  guarded(0);
  for (; started < n; ++started) guarded(started);
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

/** Calls work(thread, i) for all i below numTasks: each thread takes the next when it is done with
 * one. */
template <typename F>
void shareOut(int threads, std::size_t numTasks, const F& work) {
  std::atomic<std::size_t> next{0};
  inParallel(threads, [&](int thread) {
    for (std::size_t i; (i = next++) < numTasks;) work(thread, i);
  });
}

}  // namespace semantic_octree
