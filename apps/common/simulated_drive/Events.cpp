#include "Events.h"

#include <synthetic_world/Objects.h>

#include <algorithm>
#include <cmath>

#include "poses/Poses.h"

namespace simulated_drive {

using poses::parseNumbers;
using synthetic_world::Solids;
using synthetic_world::World;

namespace {

Eigen::Vector3d onGround(const World& world, const Eigen::Vector2d& p) {
  return {p.x(), p.y(), world.groundHeight(p.x(), p.y())};
}

Solids personAt(const World& world, const Events::Person& person, double time) {
  const Eigen::Vector2d way = person.to - person.from;
  const double walked = std::min(way.norm(), person.speed * (time - person.begin));
  const Eigen::Vector2d place =
      way.norm() > 0 ? Eigen::Vector2d(person.from + way.normalized() * walked) : person.from;
  const double stride = walked < way.norm() ? walked / 0.7 : 0;
  return synthetic_world::person(onGround(world, place), std::atan2(way.y(), way.x()),
                                 {188, 62, 52}, stride);
}

}  // namespace

Solids Events::at(const World& world, double time) const {
  Solids solids;
  const auto add = [&solids](const Solids& more) {
    solids.insert(solids.end(), more.begin(), more.end());
  };
  for (const Person& person : persons)
    if (time >= person.begin && time < person.end) add(personAt(world, person, time));
  for (const Roadblock& block : roadblocks)
    if (time >= block.begin)
      add(synthetic_world::roadblock(onGround(world, block.at), block.yaw, block.length));
  return solids;
}

bool Events::sensorsWork(double time) const {
  return std::none_of(dropouts.begin(), dropouts.end(),
                      [time](const Span& s) { return time >= s.begin && time < s.end; });
}

std::vector<Events::Roadblock> barriersAround(const Eigen::Vector2d& middle, double half) {
  const double length = 2 * half;
  const Eigen::Vector2d x(half, 0), y(0, half);
  return {{0, middle + x, 0, length},
          {0, middle - x, 0, length},
          {0, middle + y, M_PI / 2, length},
          {0, middle - y, M_PI / 2, length}};
}

Events::Person parsePerson(const std::string& text) {
  const auto n = parseNumbers(text, 5, 6, "BEGIN,X,Y,X2,Y2 or BEGIN,X,Y,X2,Y2,END");
  Events::Person person;
  person.begin = n[0], person.from = {n[1], n[2]}, person.to = {n[3], n[4]};
  if (n.size() > 5) person.end = n[5];
  return person;
}

Events::Roadblock parseRoadblock(const std::string& text) {
  const auto n = parseNumbers(text, 5, 5, "BEGIN,X,Y,DEG,LENGTH");
  return {n[0], {n[1], n[2]}, n[3] * M_PI / 180, n[4]};
}

Events::Span parseSpan(const std::string& text) {
  const auto n = parseNumbers(text, 2, 2, "BEGIN,END");
  return {n[0], n[1]};
}

}  // namespace simulated_drive
