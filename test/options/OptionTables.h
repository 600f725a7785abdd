#pragma once
#include <strict_files/OptionList.h>

#include <memory>
#include <string>
#include <vector>

/** The options of a section of a file. */
struct OptionTable {
  std::string title;
  std::string where;  ///< programs and files that have it; more about it
  strict_files::OptionList list;
  std::vector<std::shared_ptr<void>> owners;  ///< the structs that the list refers to
};

/** All tables of the handbook's page of options, in its order. */
std::vector<OptionTable> optionTables();

std::string optionsPage();
