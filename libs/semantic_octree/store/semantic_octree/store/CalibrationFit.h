#pragma once
#include <semantic_octree/ClassBelief.h>
#include <semantic_octree/FilterParameters.h>

#include <array>
#include <cmath>
#include <vector>

namespace semantic_octree {

/** e^x of x <= 0, to 1e-15 of itself; 0 below -700. The same bits everywhere: the standard
 * library's differ between its implementations. */
inline double exactExponential(double x) {
  constexpr double kLn2 = 0.69314718055994531;
  if (!(x >= -700)) return 0;
  const double power = std::floor(x / kLn2 + 0.5), rest = x - power * kLn2;
  double sum = 1;
  for (int i = 13; i > 0; --i) sum = 1 + sum * rest / i;
  return std::ldexp(sum, static_cast<int>(power));
}

/** ln x of x > 0, to 1e-15; the same bits everywhere. */
inline double exactLogarithm(double x) {
  constexpr double kLn2 = 0.69314718055994531;
  int power;
  const double part = std::frexp(x, &power), z = (part - 0.75) / (part + 0.75);
  double sum = 0;
  for (int i = 23; i > 0; i -= 2) sum = sum * z * z + 1.0 / i;
  constexpr double kLn075 = -0.28768207245178093;
  return 2 * z * sum + kLn075 + power * kLn2;
}

/** Who learns more believes, in the mean, what was believed before. \param gain what the mean gains
 * if what is learned counts by a share, over which it falls \return the share that gains nothing,
 * [0, 1], to 2^-halvings */
template <typename Gain>
double shareWithoutGain(int halvings, const Gain& gain) {
  double least = 0, most = 1;
  for (; halvings > 0; --halvings) {
    const double middle = (least + most) / 2;
    (gain(middle) > 0 ? least : most) = middle;
  }
  return (least + most) / 2;
}

/** Finds the Calibration of beliefs from what they are about. Only additions, multiplications and
 * divisions are made: results are the same bits everywhere. */
class CalibrationFit {
 public:
  /** A cell of which the filter believes this.
   * \param classes K probabilities of what it is */
  void add(const ClassBelief& belief, const std::vector<double>& classes, double weight);
  bool empty() const { return m_questions.empty(); }
  /** What makes -sum weight sum_k p_k ln(stated p(class k | occupied)) least, p_k what cells are.
   * \param calibration where the search begins; where nothing is shared, or no class has a factor,
   * nothing or none will */
  Calibration fit(Calibration calibration) const;

 private:
  struct Question {
    int named, unnamed;  ///< how many classes
    std::array<ClassId, 3> ids;
    std::array<double, 4> ahead{};   ///< log-odds of the named less the largest; last: of others
    std::array<double, 4> target{};  ///< p(class), last: of all others together
    double weight;
  };
  struct Step;

  std::vector<Question> m_questions;
  std::vector<double> m_unnamed;  ///< of each class, what cells are that do not name it
};

}  // namespace semantic_octree
