#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "figures/FigureScript.h"

namespace {

using Eigen::Vector3d;

/** Linear RGB of "#rrggbb". */
Vector3d linearRgb(const std::string& color) {
  Vector3d rgb;
  for (int i = 0; i < 3; ++i) {
    const double c = std::stoi(color.substr(std::size_t(1 + 2 * i), 2), nullptr, 16) / 255.0;
    rgb[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

/** What somebody without M cones sees: G. Machado, M. Oliveira, L. Fernandes, "A Physiologically-
 * based Model for Simulation of Color Vision Deficiency", 2009, table 1. */
Vector3d withDeuteranopia(const Vector3d& rgb) {
  Eigen::Matrix3d machado;
  machado << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  return (machado * rgb).cwiseMax(0).cwiseMin(1);
}

/** CIE 1976 L*a*b*, of the white D65. */
Vector3d labOf(const Vector3d& rgb) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f(rgb.dot(Vector3d(0.4124, 0.3576, 0.1805)) / 0.9505),
               y = f(rgb.dot(Vector3d(0.2126, 0.7152, 0.0722))),
               z = f(rgb.dot(Vector3d(0.0193, 0.1192, 0.9505)) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double difference(std::size_t a, std::size_t b) {
  const auto seen = [](std::size_t i) {
    return labOf(withDeuteranopia(linearRgb(figures::colorOf(i))));
  };
  return (seen(a) - seen(b)).norm();
}

}  // namespace

TEST(FigureColors, AreToldApartWithDeuteranopia) {
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT(difference(a, b), a < 5 ? 20 : 15) << figures::colorOf(a) << figures::colorOf(b);
}

TEST(FigureColors, ComeWithDashesAndPointsOfTheirOwn) {
  for (std::size_t a = 0; a < 5; ++a)
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_NE(std::string(figures::dashOf(a)), figures::dashOf(b));
      EXPECT_NE(figures::pointOf(a), figures::pointOf(b));
    }
}
