#pragma once
#include <colored_graph/Edge.h>

#include <cstddef>
#include <cstdint>

namespace colored_graph {

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
  /** Of those that are not wide: kUnevaluated, kBlocked, or a class above kFirstClass. */
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
