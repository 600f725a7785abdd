#include "Comparison.h"

#include <algorithm>
#include <stdexcept>

#include "ChildProcess.h"
#include "measuring/Quantile.h"
#include "measuring/Stopwatch.h"

namespace insertion_benchmark {

using namespace measuring;

namespace {

enum Figure { kCpuMedian, kCpu95, kWallMedian, kMapBytes, kPeakBytes, kTouched, kNumFigures };

/** One turn: the figures of one runner that inserts all scans. */
std::vector<double> runTurn(const Entry& entry, const Scene& scene, const Settings& settings) {
  const std::unique_ptr<Runner> runner = entry.create(scene, settings);
  const double before = residentBytes();
  resetPeak();
  std::vector<double> cpu, wall;
  for (std::size_t i = 0; i < scene.scans.size(); ++i) {
    const Stopwatch processor(TimeOf::Process), clock;
    runner->insert(i);
    wall.push_back(clock.milliseconds());
    cpu.push_back(processor.milliseconds());
  }
  std::vector<double> figures(kNumFigures);
  figures[kPeakBytes] = peakBytes() - before;
  figures[kMapBytes] = residentBytes() - before;
  figures[kCpuMedian] = median(cpu);
  figures[kCpu95] = quantile(cpu, 0.95);
  figures[kWallMedian] = median(wall);
  figures[kTouched] = static_cast<double>(runner->touchedVoxels());
  return figures;
}

}  // namespace

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

double Result::cpu() const { return median(cpuMedians); }
double Result::wall() const { return median(wallMedians); }
double Result::cpu95thPercentile() const { return median(cpu95thPercentiles); }
double Result::spread() const {
  const auto [least, most] = std::minmax_element(cpuMedians.begin(), cpuMedians.end());
  return (*most - *least) / cpu();
}

std::vector<Result> compare(const std::vector<Entry>& entries, const Scene& scene,
                            const Settings& settings, int repeats,
                            const std::function<void(const std::string&)>& onTurn) {
  std::vector<Result> results(entries.size());
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (std::size_t i = 0; i < entries.size(); ++i) {
      onTurn(entries[i].name);
      Result& r = results[i];
      r.name = entries[i].name;
      try {
        const std::vector<double> figures =
            runInChild([&] { return runTurn(entries[i], scene, settings); });
        r.cpuMedians.push_back(figures.at(kCpuMedian));
        r.cpu95thPercentiles.push_back(figures.at(kCpu95));
        r.wallMedians.push_back(figures.at(kWallMedian));
        r.mapBytes = figures.at(kMapBytes);
        r.peakBytes = figures.at(kPeakBytes);
        r.touchedVoxels = figures.at(kTouched);
      } catch (const std::exception& e) {
        throw std::runtime_error(r.name + ": " + e.what());
      }
    }
  return results;
}

}  // namespace insertion_benchmark
