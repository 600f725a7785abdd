#pragma once
#include <semantic_types/ClassTable.h>

#include <initializer_list>
#include <string>

/** A class as tests write it: {"road", {90, 90, 100}}, or only "road". */
struct NamedColor {
  NamedColor(const char* n, semantic_types::Color c = {}) : name(n), color(c) {}
  std::string name;
  semantic_types::Color color;
};

/** The table of these classes, numbered from 1 on. */
inline semantic_types::ClassTable tableOf(std::initializer_list<NamedColor> classes) {
  semantic_types::ClassTable table;
  for (const NamedColor& c : classes) table.add(c.name, c.color);
  return table;
}
