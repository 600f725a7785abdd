#pragma once
#include <functional>
#include <vector>

namespace insertion_benchmark {

/** Runs an action in a child process (so that memory starts from the same state each time) and
 * returns the numbers that it makes.
 * \throw std::runtime_error what the action threw, or how the child ended. */
std::vector<double> runInChild(const std::function<std::vector<double>()>& action);

/** Resident memory of this process, bytes. */
double residentBytes();
/** Most resident memory since resetPeak(). */
double peakBytes();
void resetPeak();

}  // namespace insertion_benchmark
