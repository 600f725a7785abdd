#pragma once
#include <colored_graph/ClassOrder.h>

#include <cstddef>
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

/** The stretches of an edge; valid until the graph changes. */
class Stretches {
 public:
  Stretches() = default;
  explicit Stretches(const Stretch& only) : m_only(only), m_size(1) {}
  explicit Stretches(const EdgeProfile& profile) : m_many(profile.data()), m_size(profile.size()) {}

  const Stretch* begin() const { return m_many ? m_many : &m_only; }
  const Stretch* end() const { return begin() + m_size; }
  std::size_t size() const { return m_size; }
  bool empty() const { return m_size == 0; }
  const Stretch& operator[](std::size_t i) const { return begin()[i]; }
  /** A copy that outlives a change. */
  operator EdgeProfile() const { return {begin(), end()}; }

 private:
  Stretch m_only{};
  const Stretch* m_many = nullptr;
  std::size_t m_size = 0;
};

/** What a graph knows of an edge. */
struct Edge {
  VertexId a = kNoVertex, b = kNoVertex;
  Length length = 0;  ///< of the profile; while unevaluated a lower bound of it
  EdgeState state = EdgeState::Unevaluated;
  Tolls tolls;
  Stretches profile;  ///< empty unless usable; a class may appear more than once

  VertexId other(VertexId v) const { return v == a ? b : a; }
  Length tollTo(VertexId v) const { return v == b ? tolls.toB : tolls.toA; }
  bool leadsTo(VertexId v) const { return tollTo(v) != kClosed; }
};

/** Which way an edge is driven, as seen from one of its ends. */
enum class Way : std::uint8_t { Out, In };

/** An edge as one of its ends keeps it, in 8 bytes: most edges are short, have no toll and lie in
 * one class of small number. What is said of others stands elsewhere (WideEdge). */
struct HalfEdge {
  static constexpr unsigned kUnevaluated = 0, kBlocked = 1, kFirstClass = 2, kKinds = 32;
  static constexpr Length kLongest = (1 << 24) - 1;  // 1.6 km

  VertexId neighbor = kNoVertex;
  std::uint32_t bits = 0;  // wide: 1 and the place; else: 0, closed in, closed out, kind, length

  static HalfEdge narrow(VertexId neighbor, unsigned kind, Length length, bool out, bool in) {
    return {neighbor, (in ? 0u : 1u << 30) | (out ? 0u : 1u << 29) | kind << 24 |
                          static_cast<std::uint32_t>(length)};
  }
  static HalfEdge wide(VertexId neighbor, std::uint32_t place) {
    return {neighbor, 1u << 31 | place};
  }

  bool isWide() const { return bits >> 31; }
  std::uint32_t place() const { return bits & ~(1u << 31); }
  /** What an edge that is not wide is: kUnevaluated, kBlocked, or a class above kFirstClass. */
  unsigned kind() const { return bits >> 24 & (kKinds - 1); }
  Length length() const { return bits & kLongest; }
  bool leads(Way way) const { return !(bits >> (way == Way::Out ? 29 : 30) & 1); }
};

/** What a half edge has no room for. */
struct WideEdge {
  VertexId a = kNoVertex;
  EdgeState state = EdgeState::Unevaluated;
  Length length = 0;
  Tolls tolls;
  EdgeProfile profile;

  Length toll(VertexId at, Way way) const {
    return (at == a) == (way == Way::Out) ? tolls.toB : tolls.toA;
  }
};

/** The edges at a vertex, in no particular order; valid until the graph changes. */
struct EdgeRow {
  const HalfEdge* halves;
  const EdgeId* edges;
  std::size_t size;
};

}  // namespace colored_graph
