#pragma once
#include <string>
#include <vector>

#include "ExploreTrial.h"

namespace drive_study {

/** A line for each look: how much of the relevant ground was known after so many meters. */
std::string toCsv(const std::vector<ExploreTrial>& trials);
/** A table of strategies: medians of the meters to 50, 80 and 90 %, and how many came so far. */
std::string toMarkdown(const std::vector<ExploreTrial>& trials);

}  // namespace drive_study
