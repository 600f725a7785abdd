// A drive through a street, in keyframes of five scans; then a tenth
// of the keyframes gets other poses.
#include <benchmark/benchmark.h>
#include <map_correction/KeyframeMap.h>
#include <semantic_abstraction/Abstraction.h>

#include <filesystem>

#include "StreetDrive.h"

using namespace street_drive;

namespace {

constexpr int kScansOfKeyframe = 5, kKeyframes = kScans / kScansOfKeyframe;

void fill(KeyframeMap& keyframes) {
  for (int i = 0; i < kScans; ++i) {
    if (i % kScansOfKeyframe == 0) keyframes.begin(Eigen::Isometry3d::Identity());
    keyframes.insert(scans()[i].cloud, scans()[i].T_map_sensor, insertion());
  }
}

void mapping(benchmark::State& state) {
  scans();
  for (auto _ : state) {
    SemanticOcTree map = emptyMap(state.range(0));
    insertAll(map);
    state.counters["MB"] = static_cast<double>(map.memoryUsage()) / 1e6;
  }
}

void mappingKeyframes(benchmark::State& state) {
  scans();
  for (auto _ : state) {
    SemanticOcTree map = emptyMap(state.range(0));
    KeyframeMap keyframes(map, std::filesystem::temp_directory_path());
    fill(keyframes);
    state.counters["MB"] = static_cast<double>(map.memoryUsage()) / 1e6;
    state.counters["MB_kept"] = static_cast<double>(keyframes.bytes().inMemory) / 1e6;
    state.counters["MB_on_disk"] = static_cast<double>(keyframes.bytes().onDisk) / 1e6;
  }
}

/** Keyframes from one on, back and forth. \param spread meters */
std::vector<KeyframePose> corrections(const KeyframeMap& keyframes, int first, int number,
                                      double spread) {
  static std::mt19937 random(5);
  std::vector<KeyframePose> poses;
  for (int i = first; i < first + number; ++i) {
    Eigen::Isometry3d T = keyframes.pose(i);
    T.translation() = randomPose(random, spread).translation();
    poses.push_back({KeyframeId(i), T});
  }
  return poses;
}

void correct(benchmark::State& state, int first, int number, double spread) {
  SemanticOcTree map = emptyMap(state.range(0));
  KeyframeMap keyframes(map, std::filesystem::temp_directory_path());
  fill(keyframes);
  CorrectionReport report;
  for (auto _ : state) report = keyframes.move(corrections(keyframes, first, number, spread));
  state.counters["traced"] = static_cast<double>(report.scansTraced);
  state.counters["merged"] = static_cast<double>(report.scansMerged);
  state.counters["tiles"] = static_cast<double>(report.tiles);
}

void correctTheLastTenth(benchmark::State& state) {
  correct(state, kKeyframes * 9 / 10, kKeyframes / 10, 0.3);
}

void correctATenthInTheMiddle(benchmark::State& state) {
  correct(state, kKeyframes / 2, kKeyframes / 10, 0.3);
}

void correctOneInTheMiddle(benchmark::State& state) { correct(state, kKeyframes / 2, 1, 0.3); }

void correctAll(benchmark::State& state) { correct(state, 0, kKeyframes, 0.3); }

BENCHMARK(mapping)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(mappingKeyframes)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(correctTheLastTenth)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(correctATenthInTheMiddle)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(correctOneInTheMiddle)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(correctAll)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
