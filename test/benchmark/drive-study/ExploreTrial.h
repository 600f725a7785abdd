#pragma once
#include <synthetic_world/Scene.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <set>
#include <string>
#include <vector>

#include "simulated_drive/DriveConfig.h"

namespace drive_study {

/** How places to look from are chosen. The nearest border of the known; information of all classes,
 * with unknown space alike; or information of what weights ask for, by a learned prior. */
enum class Exploring { Frontier, Plain, Relevant };
inline strict_files::Choices<Exploring> choicesOf(Exploring) {
  return {{"frontier", Exploring::Frontier},
          {"plain", Exploring::Plain},
          {"relevant", Exploring::Relevant}};
}

/** What is looked for: the weights, and the ground or things that are to be known in the end. */
struct ExploreTask {
  tree_abstraction::AbstractionWeights weights;
  std::set<semantic_types::ClassId> classes;  ///< classes of all that is relevant
  double within = 50;                         ///< m from the world's middle, along x and y
};

/** How much of it a map knows, after so many meters. */
struct KnownAfter {
  double meters = 0, share = 0;
};

/** The first look after a choice. */
struct KeptPromise {
  double promised = 0;  ///< nats
  double came = 0;      ///< columns that are right since
};

struct ExploreTrial {
  std::string scene;
  int number = 0;
  Exploring how = Exploring::Relevant;
  mrpt::math::TPose2D start;
  std::vector<KnownAfter> known;
  std::vector<KeptPromise> promises;
  std::string end;  ///< why it is over
  int collisions = 0;
  std::vector<mrpt::math::TPose2D> track;

  double meters() const { return known.empty() ? 0 : known.back().meters; }
  double share() const { return known.empty() ? 0 : known.back().share; }
  /** Meters until so much was known; infinite: never. */
  double metersTo(double share) const;
  /** Rank correlation of what looks promised and what came (Spearman); nan: fewer than two. */
  double promiseAgainstWhatCame() const;
};

/** A robot that glides along planned paths, without time, and looks around each meter: where it
 * looks next is all that matters. \param order of the planner */
ExploreTrial explore(const simulated_drive::DriveConfig& config,
                     const synthetic_world::Scene& scene, const colored_graph::ClassOrder& order,
                     const ExploreTask& task, const mrpt::math::TPose2D& start, Exploring how);

/** A line for each look: how much of the relevant ground was known after so many meters. */
std::string toCsv(const std::vector<ExploreTrial>& trials);

}  // namespace drive_study
