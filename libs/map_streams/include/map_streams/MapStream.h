#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace semantic_octree {

/** \file
 * A compressed tree in packets, over a radio that loses, exchanges and repeats them.
 *
 * The tree's leaves travel in the order of the alphas at which they appear (see AlphaTrees). First
 * come the blocks, each a leaf; then, by falling alpha, the eight children of each node that is
 * expanded. So each prefix is an optimal tree. Packets can be read one by one; what is told of a
 * node that is not there yet waits for it. A map that changed is told by what differs from the tree
 * that the receiver has. Nothing here knows of sockets or clocks. */

constexpr std::size_t kMaxDatagramBytes = 1000;

/** What travels at once, at most kMaxDatagramBytes. */
struct Datagram {
  enum class Type : std::uint8_t {
    Request = 1,  ///< receiver: these weights, behind the cookie
    Data,         ///< sender
    Receipt,      ///< receiver: what of the data came
    End,          ///< sender: nothing comes any more; receiver: this is enough
    Refusal,      ///< sender: why there will be nothing, a text
    Cookie        ///< sender: what a request has to show
  };
  Type type = Type::Data;
  /** Chosen by the receiver; all that belongs to its map has it. */
  std::uint32_t stream = 0;
  std::string payload;

  std::string bytes() const;
  /** \throw std::runtime_error not of this program, of another version, cut, or altered (all bytes
   * are covered by a checksum). */
  static Datagram of(const std::string& bytes);
};

/** How far a prefix of a stream leads. */
struct StreamPrefix {
  std::size_t packets = 0;
  std::size_t bytes = 0;  ///< of all datagrams up to its end
  /** The prefix's tree is the compressed one of this alpha: there, the largest J belongs to it.
   * None: blocks are missing, or the prefix ends within what belongs together. */
  std::optional<double> alpha;
  /** The tree is the smallest of this alpha, as Abstraction has it: all that goes with it is there.
   */
  bool isWhole = false;
};

/** Sends a map to one receiver. */
class MapSender {
 public:
  explicit MapSender(std::uint32_t stream);
  ~MapSender();
  MapSender(MapSender&&) noexcept;

  /** Begins with a map, or goes on with what it became meanwhile: computes the packets.
   * \param map keeps G-values (setAbstraction()), always of the same weights
   * \param isLast no other map comes behind it
   * \throw std::logic_error the receiver does not have all of the map before, or that was the last,
   * or it keeps none
   * \throw std::invalid_argument of another resolution, filter or class table, or other blocks,
   * than the one before; or more than kMaxPackets packets. */
  void setMap(SemanticOcTree& map, bool isLast = true);
  static constexpr std::size_t kMaxPackets = 1 << 20;

  /** What to send next: new packets, and before them those which a receipt told were lost. None:
   * all were sent. */
  std::optional<Datagram> next();
  /** A receipt. \return whether it tells anything new
   * \throw std::runtime_error of another stream, or altered. */
  bool accept(const Datagram& receipt);
  /** Nothing was heard for a while: what was not acknowledged is sent once more. */
  void repeat();
  /** The receiver has all of the map. */
  bool isComplete() const;

  /** After each of the map's packets, in the order of their numbers. */
  const std::vector<StreamPrefix>& prefixes() const;

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

/** Receives what a MapSender sends. */
class MapReceiver {
 public:
  explicit MapReceiver(std::uint32_t stream);
  ~MapReceiver();
  MapReceiver(MapReceiver&&) noexcept;

  /** Data; what came before is ignored. The map stays valid if this fails.
   * \throw std::runtime_error of another stream, or altered; or the map is complete and not the
   * sender's. */
  void accept(const Datagram& data);
  /** What came, for the sender. */
  Datagram receipt() const;
  /** All of a map, or of its last change, is there. */
  bool isComplete() const;
  /** And nothing else comes. */
  bool isFinished() const;

  /** There is a map: which classes it has is known. */
  bool hasMap() const;
  /** What is known up to now. \throw std::logic_error there is none. */
  SemanticOcTree map() const;
  std::size_t numLeaves() const;
  /** The packets of the present map or change that came without a gap. */
  StreamPrefix prefix() const;
  /** All packets of the present map or change that came, and that there are (0: not known yet). */
  std::size_t numPackets() const;
  std::size_t numExpected() const;

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

/** Tells any number of copies what becomes of a map's compressed tree, by messages that arrive in
 * order or are lost, as topics' do. */
class TreeBroadcast {
 public:
  /** \param map keeps G-values (setAbstraction()) before the first call, and outlives this
   * \param stream another one each time that one begins */
  TreeBroadcast(SemanticOcTree& map, std::uint32_t stream);
  ~TreeBroadcast();
  TreeBroadcast(TreeBroadcast&&) noexcept;

  /** What changed since the last call; the first time, after another abstraction, and of another
   * kind of map all of it. Takes time for what changed. Empty: nothing did.
   * \throw std::logic_error the map keeps no G-values. Then, and if memory is short, the next call
   * tells everything. */
  std::string change();
  /** All that was told up to now: for who comes late, or lost a change. */
  std::string all() const;

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

/** A copy of the compressed tree that a TreeBroadcast tells of. Its cells are the tree's to the
 * last bit; its calibration is that of when the map's was another for the last time. */
class TreeCopy {
 public:
  TreeCopy();
  ~TreeCopy();
  TreeCopy(TreeCopy&&) noexcept;

  /** Takes a change(), or all(). What is known already is ignored; what lacks something before it
   * waits for that, or for all(). \return isCurrent()
   * \throw std::runtime_error altered; if it was a change, all() is needed. */
  bool accept(const std::string& message);
  /** Nothing that was heard of is missing. Otherwise a message with all() is needed, and the map is
   * that of some time before. */
  bool isCurrent() const;
  /** \throw std::logic_error nothing came yet. */
  SemanticOcTree map() const;
  std::size_t numLeaves() const;

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

}  // namespace semantic_octree
