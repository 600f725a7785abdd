#pragma once
#include <mrpt/math/TPose2D.h>
#include <strict_files/TextFile.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace poses {

/** Numbers between commas. \param expected what to say that they are
 * \throw std::invalid_argument what is no finite number, or not as many as expected */
std::vector<double> parseNumbers(const std::string& text, std::size_t least, std::size_t most,
                                 const std::string& expected);

/** "X,Y,DEG", meters and degrees. \throw std::invalid_argument naming the text */
mrpt::math::TPose2D parsePose(const std::string& text);

/** An option that hands each of its texts to a function, whose errors are the command line's. */
template <class Take>
CLI::Option* addParsed(CLI::App& app, const std::string& name, const std::string& type, Take take,
                       const std::string& description) {
  const auto taken = [take, name](const CLI::results_t& texts) {
    try {
      for (const std::string& text : texts) take(text);
    } catch (const std::invalid_argument& e) {
      throw CLI::ValidationError(name, e.what());
    }
    return true;
  };
  return app.add_option(name, taken, description)->type_name(type);
}

/** A pose of a command line: "X,Y,DEG". */
CLI::Option* addPose(CLI::App& app, const std::string& name, mrpt::math::TPose2D& pose,
                     const std::string& description);

/** \param v x, y, z (m), yaw, pitch, roll (degrees), as MRPT's CPose3D. */
Eigen::Isometry3d poseOfNumbers(const std::array<double, 6>& v);

/** A pose as KITTI's files have it: the twelve numbers of a 3x4 row-major matrix [R|t], m.
 * \throw std::runtime_error naming the line: others, or R is no rotation. */
Eigen::Isometry3d poseOfMatrix(const strict_files::TextLine& line);

}  // namespace poses
