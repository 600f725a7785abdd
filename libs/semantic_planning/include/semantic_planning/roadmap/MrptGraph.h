#pragma once
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <semantic_planning/roadmap/Roadmap.h>

#include <string>
#include <vector>

namespace semantic_planning {

/** What a network's node says of its class: "class road" behind the pose in a .graph file. */
struct VertexClass : mrpt::graphs::detail::TNodeAnnotations {
  std::string name;
  void getAnnotsAsString(std::string* text) const override { *text = "class " + name; }
};

using ClassNetwork =
    mrpt::graphs::CNetworkOfPoses<mrpt::poses::CPose2D, mrpt::containers::map_traits_stdmap,
                                  VertexClass>;

/** A roadmap as MRPT knows graphs. Nodes have their global poses and classes; each usable or
 * unevaluated edge has the pose of its end as seen from its start. saveToTextFile() writes a .graph
 * file, which CNetworkOfPoses2D and MRPT's applications read.
 * \param classNames by class id. */
ClassNetwork toNetwork(const Roadmap& roadmap, const std::vector<std::string>& classNames);

}  // namespace semantic_planning
