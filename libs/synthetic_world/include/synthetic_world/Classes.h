#pragma once
#include <semantic_types/ClassTable.h>

namespace synthetic_world {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::kNoClass;

/** The classes of every synthetic scene, in the order of config/classes/synthetic.yaml. */
enum Class : ClassId {
  kRoad = 1,
  kLaneMarking,
  kSidewalk,
  kGravel,
  kDirt,
  kGrass,
  kFlowerBed,
  kWater,
  kTrunk,
  kCanopy,
  kBush,
  kRock,
  kBuilding,
  kWindow,
  kRoof,
  kWall,
  kFence,
  kPole,
  kSign,
  kBench,
  kCar,
  kPerson
};
constexpr int kClassCount = kPerson;

/** Their names and the colors in which maps show them. */
const ClassTable& classTable();

/** What such things look like to a color camera. */
Color naturalColor(ClassId id);

}  // namespace synthetic_world
