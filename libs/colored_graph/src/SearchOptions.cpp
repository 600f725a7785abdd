#include <colored_graph/SearchOptions.h>

#include <stdexcept>
#include <string>

namespace colored_graph {

void SearchOptions::validate() const {
  if (!(timeLimit >= 0))
    throw std::invalid_argument("SearchOptions: timeLimit " + std::to_string(timeLimit) +
                                " s, expected 0 or more");
}

}  // namespace colored_graph
