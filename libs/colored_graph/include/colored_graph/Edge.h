#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/Length.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace colored_graph {

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

}  // namespace colored_graph
