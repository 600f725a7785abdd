#pragma once
#include <semantic_types/ClassTable.h>

#include <functional>
#include <string>
#include <vector>

/** What reads files of others: whatever the bytes are, it either takes them or throws. */
struct Reader {
  std::string name;  ///< of its folder in corpus/, too
  std::function<void(const std::string& bytes)> read;
  /** Good files, from the root of the sources, to begin with. */
  std::vector<std::string> examples;
};

/** Of maps' files and folders, and of what comes by radio. */
std::vector<Reader> mapReaders();
/** Of the libraries' other functions. */
std::vector<Reader> libraryReaders();
/** Of what only programs read. */
std::vector<Reader> programReaders();
/** All of them. */
const std::vector<Reader>& readers();

/** Of the maps and files that readers expect. */
const semantic_types::ClassTable& fuzzedClasses();
