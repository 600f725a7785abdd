#include "Report.h"

#include <cmath>
#include <iomanip>
#include <ostream>

#include "JsonFile.h"

namespace insertion_benchmark {
namespace {

/** CPU time of the reference, NaN if it did not run. */
double referenceCpu(const std::vector<Result>& results, const std::string& reference) {
  for (const Result& r : results)
    if (r.name == reference) return r.cpu();
  return NAN;
}

const char* nameOf(semantic_octree::InsertionOptions::Rays rays) {
  return rays == semantic_octree::InsertionOptions::Rays::All ? "all" : "endpoints";
}

/** A number, or a dash if it is not known. */
std::string number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::ostringstream out;
  out << std::fixed << std::setprecision(decimals) << value;
  return out.str();
}

double bytesPerVoxel(const Result& r, const Conditions& c) {
  return c.touchedVoxels > 0 ? r.mapBytes / c.touchedVoxels : NAN;
}

}  // namespace

void printTable(std::ostream& out, const Conditions& c, const std::vector<Result>& results,
                const std::string& reference) {
  out << c.scene << ": " << c.scans << " scans, " << c.points << " points; resolution "
      << c.settings.resolution << " m, range " << c.settings.maxRange << " m, rays "
      << nameOf(c.settings.rays) << ", " << c.settings.threads << " thread(s), " << c.settings.terms
      << " terms, " << c.repeats << " repeats, load average " << c.loadAverage << "\n\n"
      << std::left << std::setw(34) << "" << std::right << std::setw(10) << "CPU ms" << std::setw(9)
      << "spread" << std::setw(10) << "95 %" << std::setw(10) << "wall ms" << std::setw(10)
      << "ratio" << std::setw(12) << "bytes/vox" << std::setw(10) << "peak MB"
      << "\n";
  for (const Result& r : results)
    out << std::left << std::setw(34) << r.name << std::right << std::setw(10) << number(r.cpu(), 1)
        << std::setw(7) << number(100 * r.spread(), 0) << " %" << std::setw(10)
        << number(r.cpu95thPercentile(), 1) << std::setw(10) << number(r.wall(), 1) << std::setw(10)
        << number(r.cpu() / referenceCpu(results, reference), 2) << std::setw(12)
        << number(bytesPerVoxel(r, c), 1) << std::setw(10) << number(r.peakBytes / 1e6, 0) << "\n";
  out << "\nms per scan: median over the scans, then over the repeats. ratio: CPU time over that "
         "of "
      << reference << ".\n";
}

void printJson(std::ostream& out, const Conditions& c, const std::vector<Result>& results,
               const std::string& reference) {
  nlohmann::json json = {{"scene", c.scene},
                         {"scans", c.scans},
                         {"points", c.points},
                         {"resolution", c.settings.resolution},
                         {"maxRange", c.settings.maxRange},
                         {"rays", nameOf(c.settings.rays)},
                         {"terms", c.settings.terms},
                         {"threads", c.settings.threads},
                         {"repeats", c.repeats},
                         {"loadAverage", c.loadAverage},
                         {"touchedVoxels", c.touchedVoxels},
                         {"ratioTo", reference}};
  for (const Result& r : results)  // what is not known becomes null
    json["contestants"].push_back({{"name", r.name},
                                   {"cpuMilliseconds", r.cpu()},
                                   {"cpuMillisecondsOfRepeats", r.cpuMedians},
                                   {"cpuMilliseconds95thPercentile", r.cpu95thPercentile()},
                                   {"wallMilliseconds", r.wall()},
                                   {"ratio", r.cpu() / referenceCpu(results, reference)},
                                   {"mapBytes", r.mapBytes},
                                   {"bytesPerTouchedVoxel", bytesPerVoxel(r, c)},
                                   {"peakBytes", r.peakBytes}});
  out << textOf(json);
}

}  // namespace insertion_benchmark
