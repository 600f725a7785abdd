#include <labeled_cloud/LabelModel.h>
#include <strict_files/OptionList.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

namespace {

using Counts = std::vector<std::vector<double>>;

/** A class that was not met where the matrix was measured may be met here. */
constexpr double kLeastShare = 1e-4;

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

void check(const Counts& counts) {
  const auto good = [](double n) { return n >= 0 && std::isfinite(n); };
  double all = 0;
  for (const auto& row : counts) {
    if (row.size() != counts.size())
      throw std::invalid_argument("confusion matrix: " + std::to_string(counts.size()) +
                                  " rows, but one of " + std::to_string(row.size()) + " columns");
    const auto bad = std::find_if_not(row.begin(), row.end(), good);
    if (bad != row.end())
      throw std::invalid_argument("confusion matrix: a count is " + strict_files::textOf(*bad) +
                                  ", expected 0 or more");
    all += sum(row);
  }
  if (!(all > 0)) throw std::invalid_argument("confusion matrix: all counts are 0");
}

/** How often each class is answered, over all true ones; never 0. */
std::vector<double> answerShares(const Counts& counts) {
  std::vector<double> shares(counts.size(), 1.0);
  for (const auto& row : counts)
    for (std::size_t c = 0; c < row.size(); ++c) shares[c] += row[c];
  const double all = sum(shares);
  for (double& share : shares) share /= all;
  return shares;
}

}  // namespace

ConfusionMatrix::ConfusionMatrix(const Counts& counts)
    : m_size(static_cast<int>(counts.size())), m_rows(counts.size() * counts.size()) {
  check(counts);
  double total = 0;
  for (const auto& row : counts) total += sum(row);
  for (const auto& row : counts)
    m_classShares.push_back(
        static_cast<float>((sum(row) / total + kLeastShare) / (1 + kLeastShare * m_size)));
  const auto shares = answerShares(counts);
  for (int answered = 0; answered < m_size; ++answered) {
    std::vector<double> likelihoods;
    for (const auto& row : counts)
      likelihoods.push_back((row[answered] + shares[answered]) / (sum(row) + 1));
    const double all = sum(likelihoods);
    for (int k = 0; k < m_size; ++k)
      m_rows[std::size_t(answered) * m_size + k] = static_cast<float>(likelihoods[k] / all);
  }
}

namespace {

/** Keeps the likeliest class of each row. */
void harden(int numClasses, LabeledCloud& cloud) {
  cloud.classes.assign(cloud.size(), kNoClass);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* row = &cloud.probabilities[i * numClasses];
    const float* best = std::max_element(row, row + numClasses);
    if (*best > 0) cloud.classes[i] = static_cast<ClassId>(best - row + 1);
  }
  cloud.probabilities.clear();
}

void dropUnsureRows(int numClasses, double minConfidence, LabeledCloud& cloud) {
  for (auto row = cloud.probabilities.begin(); row != cloud.probabilities.end(); row += numClasses)
    if (*std::max_element(row, row + numClasses) < minConfidence)
      std::fill(row, row + numClasses, 0.f);
}

void dropUnsureClasses(const std::vector<float>& confidences, double minConfidence,
                       LabeledCloud& cloud) {
  for (std::size_t i = 0; i < confidences.size(); ++i)
    if (confidences[i] < minConfidence) cloud.classes[i] = kNoClass;
}

/** Makes a row of each class: WRITE(point, class, row). */
template <typename Write>
void soften(int numClasses, LabeledCloud& cloud, Write write) {
  cloud.probabilities.assign(cloud.size() * numClasses, 0.f);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.classes[i] != kNoClass)
      write(i, cloud.classes[i], &cloud.probabilities[i * numClasses]);
  cloud.classes.clear();
}

}  // namespace

void LabelModel::describe(strict_files::OptionList& list) {
  list.add("kind", kind, "",
           "whether labels are probabilities where they can be, or the likeliest class is all that "
           "counts");
  list.add("min_confidence", minConfidence, "", strict_files::between(0, 1),
           "labels that are less sure are none");
}

void LabelModel::validate() const { strict_files::checkOptions(*this, "LabelModel"); }

void LabelModel::apply(int numClasses, const std::vector<float>& confidences,
                       LabeledCloud& cloud) const {
  if (confusion && confusion->size() != numClasses)
    throw std::invalid_argument("a confusion matrix of " + std::to_string(confusion->size()) +
                                " classes for a table of " + std::to_string(numClasses));
  if (!cloud.probabilities.empty()) {
    if (minConfidence > 0) dropUnsureRows(numClasses, minConfidence, cloud);
    if (kind == Kind::Soft) return;
    harden(numClasses, cloud);
  }
  if (cloud.classes.empty()) return;
  dropUnsureClasses(confidences, minConfidence, cloud);
  if (confusion)
    soften(numClasses, cloud, [&](std::size_t, ClassId id, float* row) {
      std::copy_n(confusion->given(id), numClasses, row);
    });
  else if (!confidences.empty() && kind == Kind::Soft && numClasses > 1)
    soften(numClasses, cloud, [&](std::size_t i, ClassId id, float* row) {
      std::fill_n(row, numClasses, (1 - confidences[i]) / static_cast<float>(numClasses - 1));
      row[id - 1] = confidences[i];
    });
}

}  // namespace labeled_cloud
