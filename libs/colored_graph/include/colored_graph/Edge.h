#pragma once
#include <colored_graph/ClassOrder.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace colored_graph {

/** A length in units of 0.1 mm. With integers, sums do not depend on their order: costs that are
 * equal compare equal, and the next class of the comparison decides. */
using Length = std::int64_t;
constexpr double kLengthUnitsPerMeter = 1e4;

/** Meters -> units, rounded up: for edges. A value within 1e-6 units of an integer is that integer,
 * because axis-aligned lengths between voxel centers carry rounding noise.
 * \throw std::invalid_argument negative, not a number, or above 2^62 units. */
Length lengthUp(double meters);

/** Meters -> units, rounded down: for lower bounds. With lengthUp() on the edges, a metric d keeps
 * lengthDown(d(a, goal)) <= lengthUp(d(a, b)) + lengthDown(d(b, goal)).
 * \throw std::invalid_argument as lengthUp(). */
Length lengthDown(double meters);

/** Units -> meters. */
inline double toMeters(Length length) { return static_cast<double>(length) / kLengthUnitsPerMeter; }

using VertexId = std::uint32_t;
using EdgeId = std::uint32_t;
constexpr VertexId kNoVertex = ~VertexId{0};
constexpr EdgeId kNoEdge = ~EdgeId{0};

/** A part of an edge that lies in one class. Length 0 means: touched. */
struct Stretch {
  GraphClass classId;
  Length length;
};
using EdgeProfile = std::vector<Stretch>;

/** Unevaluated: only a lower bound of the length is known. Blocked: nobody can go there. */
enum class EdgeState : std::uint8_t { Unevaluated, Usable, Blocked };

/** In place of a toll: nobody may go this way. */
constexpr Length kClosed = std::numeric_limits<Length>::max();

/** What an edge costs beside its length, as a length, by the way it is driven: a price of meters
 * backwards, of changes of gear. They do not depend on the classes along the edge and are known
 * before it is evaluated. {0, kClosed} is an edge that leads from a to b only. */
struct Tolls {
  Length toB = 0, toA = 0;
};

/** What a graph knows of an edge. */
struct Edge {
  VertexId a = kNoVertex, b = kNoVertex;
  Length length = 0;  ///< of the profile; while unevaluated a lower bound of it
  EdgeState state = EdgeState::Unevaluated;
  Tolls tolls;
  EdgeProfile profile;  ///< empty unless usable; a class may appear more than once

  VertexId other(VertexId v) const { return v == a ? b : a; }
  Length tollTo(VertexId v) const { return v == b ? tolls.toB : tolls.toA; }
  bool leadsTo(VertexId v) const { return tollTo(v) != kClosed; }
};

}  // namespace colored_graph
