#include <synthetic_world/Solids.h>

namespace synthetic_world {
namespace {

struct Row {
  const char* name;
  Color map, natural;
};

constexpr Row kRows[kClassCount] = {
    {"road", {92, 92, 104}, {98, 98, 102}},
    {"lane-marking", {245, 245, 235}, {228, 228, 222}},
    {"sidewalk", {186, 178, 190}, {176, 172, 166}},
    {"gravel", {214, 194, 148}, {190, 176, 150}},
    {"dirt", {160, 112, 66}, {142, 108, 76}},
    {"grass", {138, 196, 84}, {104, 142, 62}},
    {"flower-bed", {236, 110, 190}, {196, 92, 140}},
    {"water", {66, 152, 222}, {74, 112, 140}},
    {"trunk", {92, 58, 30}, {96, 74, 54}},
    {"canopy", {26, 112, 48}, {58, 104, 44}},
    {"bush", {92, 150, 108}, {74, 118, 52}},
    {"rock", {136, 140, 150}, {138, 134, 128}},
    {"building", {236, 178, 112}, {212, 196, 170}},
    {"window", {128, 214, 232}, {74, 92, 110}},
    {"roof", {182, 70, 52}, {156, 78, 60}},
    {"wall", {184, 132, 206}, {164, 152, 138}},
    {"fence", {198, 136, 60}, {146, 112, 80}},
    {"pole", {64, 60, 130}, {116, 120, 124}},
    {"sign", {250, 212, 30}, {238, 206, 52}},
    {"bench", {128, 44, 112}, {124, 84, 52}},
    {"car", {216, 34, 48}, {170, 40, 44}},
    {"person", {255, 84, 0}, {196, 92, 60}},
};

ClassTable makeTable() {
  ClassTable table;
  for (const Row& row : kRows) table.add(row.name, row.map);
  return table;
}

}  // namespace

const ClassTable& classTable() {
  static const ClassTable table = makeTable();
  return table;
}

Color naturalColor(ClassId id) {
  classTable().color(id);  // throws for an id that is not in the table
  return kRows[id - 1].natural;
}

}  // namespace synthetic_world
