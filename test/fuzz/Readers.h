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

/** The readers of maps' files and folders, and of what comes by radio. */
std::vector<Reader> mapReaders();
/** The readers among the libraries' other functions. */
std::vector<Reader> libraryReaders();
/** The readers of what only programs read. */
std::vector<Reader> programReaders();
const std::vector<Reader>& readers();

/** The classes of the maps and files that readers expect. */
const semantic_types::ClassTable& fuzzedClasses();
