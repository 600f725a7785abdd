#include <view_information/BeamInformation.h>

#include <algorithm>
#include <cmath>

namespace view_information {

BeamModel::BeamModel(int numClasses, const semantic_octree::FilterParameters& parameters)
    : m_numClasses(numClasses),
      m_hit(parameters.hitProbability),
      m_falseAlarm(parameters.falseAlarmProbability),
      m_accuracy(numClasses > 1 ? parameters.accuracy : 1) {
  parameters.validate(numClasses);
}

double BeamModel::probability(int outcome, int cell) const {
  const double returns = cell == 0 ? m_falseAlarm : m_hit;
  if (outcome == 0) return 1 - returns;
  if (cell == 0) return returns / m_numClasses;
  return returns * (outcome == cell ? m_accuracy : (1 - m_accuracy) / (m_numClasses - 1));
}

double BeamModel::probability(int outcome, const double* p) const {
  const double occupied = 1 - p[0];
  if (outcome == 0) return p[0] * (1 - m_falseAlarm) + occupied * (1 - m_hit);
  const double other = m_numClasses > 1 ? (1 - m_accuracy) / (m_numClasses - 1) : 0;
  return p[0] * m_falseAlarm / m_numClasses +
         m_hit * (m_accuracy * p[outcome] + other * (occupied - p[outcome]));
}

double informationOfBeam(const std::vector<CellRun>& runs) {
  double reached = 1, sum = 0;
  for (const CellRun& run : runs) {
    const double left = std::pow(run.pass, run.count);
    const double observed = run.pass < 1 ? (1 - left) / (1 - run.pass) : run.count;
    sum += reached * run.value * observed;
    reached *= left;
  }
  return sum;
}

double informationOfTree(const std::vector<TreeCell>& cells) {
  std::vector<double> leaves(cells.size());  // P(a beam leaves the cell)
  double sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const TreeCell& cell = cells[i];
    const double reached = cell.parent < 0 ? 1 : leaves[static_cast<std::size_t>(cell.parent)];
    sum += reached * cell.value;
    leaves[i] = reached * cell.pass;
  }
  return sum;
}

Bounds informationOfNet(const std::vector<TreeCell>& cells,
                        const std::vector<std::vector<int>>& beams) {
  std::vector<double> most(cells.size(), 0), none(cells.size(), 1);
  for (const std::vector<int>& beam : beams) {
    double reached = 1;
    for (const int c : beam) {
      const auto i = static_cast<std::size_t>(c);
      most[i] = std::max(most[i], reached);
      none[i] *= 1 - reached;
      reached *= cells[i].pass;
    }
  }
  Bounds bounds;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double a = most[i] * cells[i].value, b = (1 - none[i]) * cells[i].value;
    bounds.lower += std::min(a, b), bounds.upper += std::max(a, b);
  }
  return bounds;
}

Bounds informationOfViews(const std::vector<std::vector<double>>& reached,
                          const std::vector<double>& values) {
  Bounds bounds;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double most = 0, sum = 0;
    for (const std::vector<double>& view : reached) most = std::max(most, view[i]), sum += view[i];
    bounds.lower += most * values[i], bounds.upper += sum * values[i];
  }
  return bounds;
}

}  // namespace view_information
