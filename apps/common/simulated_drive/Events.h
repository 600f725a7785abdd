#pragma once
#include <synthetic_world/World.h>

#include <string>
#include <vector>

namespace simulated_drive {

/** Things that happen on the way, at times in seconds. */
struct Events {
  /** Somebody walks from one place to another, and stands there until the end, if there is one. */
  struct Person {
    double begin = 0, end = 1e9;
    Eigen::Vector2d from, to;
    double speed = 1.2;  ///< m/s
  };
  /** A barrier across a way. */
  struct Roadblock {
    double begin = 0;
    Eigen::Vector2d at;
    double yaw = 0, length = 3;  ///< radians, m
  };
  struct Span {
    double begin = 0, end = 0;
  };
  std::vector<Person> persons;
  std::vector<Roadblock> roadblocks;
  std::vector<Span> dropouts;  ///< no sensor sees anything

  synthetic_world::Solids at(const synthetic_world::World& world, double time) const;
  bool sensorsWork(double time) const;
};

/** Four barriers from the beginning on, a square without a gap.
 * \param half from its middle to each side, m */
std::vector<Events::Roadblock> barriersAround(const Eigen::Vector2d& middle, double half);

/** "BEGIN,X,Y,X2,Y2" or "BEGIN,X,Y,X2,Y2,END" \throw std::invalid_argument */
Events::Person parsePerson(const std::string& text);
/** "BEGIN,X,Y,DEG,LENGTH" \throw std::invalid_argument */
Events::Roadblock parseRoadblock(const std::string& text);
/** "BEGIN,END" \throw std::invalid_argument */
Events::Span parseSpan(const std::string& text);

}  // namespace simulated_drive
