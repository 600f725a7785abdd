#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>

#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>

namespace labeled_cloud {

namespace fs = std::filesystem;
using mrpt::Clock;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;

namespace {

constexpr const char* kConfidence = ".confidence";

bool isLabelImage(const fs::path& file) {
  static const std::set<std::string> kEndings = {".png", ".tif", ".tiff", ".pgm", ".bmp"};
  return fs::is_regular_file(file) && kEndings.count(file.extension().string()) &&
         file.stem().extension() != kConfidence;
}

/** Where the confidences of a label image are. */
fs::path confidencesOf(const fs::path& labels) {
  return labels.parent_path() /
         (labels.stem().string() + kConfidence + labels.extension().string());
}

Clock::time_point timeInName(const fs::path& file) {
  const std::string stem = file.stem().string();
  double seconds = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), seconds);
  try {
    if (error == std::errc() && end == stem.data() + stem.size()) return timeOfSeconds(seconds);
  } catch (const std::invalid_argument&) {
  }
  throw std::runtime_error(file.string() + ": the label image's name is not a time in seconds");
}

/** Name of the first image of the observation that is stored in a file of its own. */
std::string externalName(const CObservation& observation) {
  if (const auto* picture = dynamic_cast<const CObservationImage*>(&observation))
    if (picture->image.isExternallyStored()) return picture->image.getExternalStorageFile();
  if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
    if (scan->hasIntensityImage && scan->intensityImage.isExternallyStored())
      return scan->intensityImage.getExternalStorageFile();
    if (scan->rangeImage_isExternallyStored()) return scan->rangeImage_getExternalStorageFile("");
  }
  throw std::runtime_error("the observation '" + observation.sensorLabel +
                           "' has no external image after which a label image could be named");
}

}  // namespace

const strict_files::Choices<LabelFolderOptions::Match>& choicesOf(LabelFolderOptions::Match) {
  using Match = LabelFolderOptions::Match;
  static const strict_files::Choices<Match> choices = {{"time", Match::Time},
                                                       {"name", Match::Name}};
  return choices;
}

void LabelFolderOptions::describe(strict_files::OptionList& list) {
  list.add("match", match, "",
           "how label images are found: their names are times, or those of the observations' own "
           "images");
  list.add("tolerance", tolerance, "s", strict_files::atLeast(0).orInfinite(),
           "largest difference to the observation's time");
  list.add("image", view, "", "which image of a depth and color camera the labels belong to");
}

void LabelFolderOptions::validate() const {
  strict_files::checkOptions(*this, "LabelFolderOptions");
}

LabelFolder::LabelFolder(const fs::path& folder, const semantic_types::ClassTable& table,
                         const LabelFolderOptions& options)
    : m_folder(folder), m_table(table), m_options(options) {
  m_options.validate();
  if (!fs::is_directory(folder))
    throw std::runtime_error(folder.string() + ": there is no such folder of label images");
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!isLabelImage(entry.path())) continue;
    const bool added = m_options.match == LabelFolderOptions::Match::Time
                           ? m_byTime.emplace(timeInName(entry.path()), entry.path()).second
                           : m_byName.emplace(entry.path().stem().string(), entry.path()).second;
    if (!added)
      throw std::runtime_error(entry.path().string() + ": a second label image of this " +
                               (m_byName.empty() ? "time" : "name"));
  }
  if (m_byTime.empty() && m_byName.empty())
    throw std::runtime_error(folder.string() + ": no label image in this folder");
  const fs::path& first = m_byTime.empty() ? m_byName.begin()->second : m_byTime.begin()->second;
  m_withConfidences = fs::exists(confidencesOf(first));
}

std::optional<fs::path> LabelFolder::nearest(Clock::time_point time) const {
  std::optional<fs::path> best;
  Clock::duration least = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(m_options.tolerance));
  const auto consider = [&](const auto& candidate) {
    const auto apart = candidate.first < time ? time - candidate.first : candidate.first - time;
    if (apart <= least) least = apart, best = candidate.second;
  };
  const auto after = m_byTime.lower_bound(time);
  if (after != m_byTime.end()) consider(*after);
  if (after != m_byTime.begin()) consider(*std::prev(after));
  return best;
}

std::optional<fs::path> LabelFolder::named(const CObservation& observation) const {
  const auto found = m_byName.find(fs::path(externalName(observation)).stem().string());
  if (found == m_byName.end()) return std::nullopt;
  return found->second;
}

std::optional<fs::path> LabelFolder::fileOf(const CObservation& observation) const {
  const bool byTime = m_options.match == LabelFolderOptions::Match::Time;
  return byTime ? nearest(observation.timestamp) : named(observation);
}

std::optional<LabelImage> LabelFolder::label(const CObservation& observation) {
  const auto file = fileOf(observation);
  if (!file) return std::nullopt;
  LabelImage image = readLabelImage(*file, m_table);
  image.view = m_options.view;
  if (m_withConfidences) readConfidences(confidencesOf(*file), image);
  return image;
}

}  // namespace labeled_cloud
