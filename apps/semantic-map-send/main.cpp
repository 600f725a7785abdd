// Sends a map's compressed tree over a thin radio, what matters most first.
#include <map_folders/MapFolder.h>
#include <map_streams/MapStream.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <list>
#include <ostream>

#include "Application.h"
#include "inputs/Inputs.h"
#include "radio/Radio.h"

namespace semantic_map_send {
namespace {
using semantic_octree::Datagram;

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

/** The maps to send, one after the other; all receivers get them. */
using Maps = std::deque<semantic_octree::StoredMap>;

/** Time after which packets without a receipt are sent again. */
constexpr std::chrono::milliseconds kPatience(500);
/** Bytes of the headers of IP and UDP. */
constexpr std::size_t kHeaders = 28;
/** Time after the end in which receivers are still told that they have all. */
constexpr std::chrono::milliseconds kFarewell(1000);
/** Longest wait for a datagram. */
constexpr std::chrono::milliseconds kTick(100);

/** One receiver: from the request that was granted to its last receipt. */
class Session {
 public:
  /** Prepares the first map. \throw std::exception it cannot be sent with these options. */
  Session(const radio::Peer& peer, std::uint32_t stream, Maps& maps,
          const semantic_octree::AbstractionOptions& options)
      : m_peer(peer), m_stream(stream), m_maps(maps), m_options(options), m_sender(stream) {
    sendNextMap();
    m_lastSent = m_lastHeard = Clock::now();
  }

  const radio::Peer& peer() const { return m_peer; }
  bool isOf(const radio::Peer& peer, std::uint32_t stream) const {
    return m_peer == peer && m_stream == stream;
  }
  /** What the receiver sends. \return whether it tells anything new, as none does that is repeated
   * \throw std::runtime_error altered */
  bool accept(const Datagram& datagram) {
    if (datagram.type != Datagram::Type::Receipt && datagram.type != Datagram::Type::End)
      return false;
    const bool isNew = m_sender && (datagram.type == Datagram::Type::End || take(datagram));
    if (datagram.type == Datagram::Type::End) m_sender.reset();
    m_owesEnd = isServed();
    if (isNew) m_lastHeard = Clock::now();
    return isNew;
  }
  /** What is to be sent to it now, if anything. */
  std::optional<Datagram> next() {
    std::optional<Datagram> datagram;
    if (std::exchange(m_owesEnd, false)) {
      datagram = {Datagram::Type::End, m_stream, ""};
    } else if (m_sender) {
      datagram = m_sender->next();
      if (!datagram && Clock::now() - m_lastSent > kPatience) {
        m_sender->repeat();
        datagram = m_sender->next();
      }
    }
    if (!datagram) return datagram;
    m_lastSent = Clock::now();
    ++m_numSent;
    m_bytesSent += datagram->bytes().size();
    return datagram;
  }

  /** Whether the receiver has all maps, or as much as it wants. */
  bool isServed() const { return !m_sender; }
  /** When it told something new. */
  Clock::time_point lastHeard() const { return m_lastHeard; }
  /** Datagrams, with those sent again; their bytes. */
  std::size_t numSent() const { return m_numSent; }
  std::size_t bytesSent() const { return m_bytesSent; }

 private:
  void sendNextMap() {
    semantic_octree::SemanticOcTree& map = m_maps[m_nextMap++].tree();
    setAbstraction(map, m_options);
    m_sender->setMap(map, m_nextMap == m_maps.size());
    dropAbstraction(map);
  }
  bool take(const Datagram& receipt) {
    const bool isNew = m_sender->accept(receipt);
    if (!m_sender->isComplete()) return isNew;
    if (m_nextMap < m_maps.size())
      sendNextMap();
    else
      m_sender.reset();
    return isNew;
  }

  radio::Peer m_peer;
  std::uint32_t m_stream;
  Maps& m_maps;
  semantic_octree::AbstractionOptions m_options;
  std::optional<semantic_octree::MapSender> m_sender;  ///< none: it is served
  std::size_t m_nextMap = 0;
  bool m_owesEnd = false;  ///< it has to be told that it is served
  Clock::time_point m_lastHeard, m_lastSent;
  std::size_t m_numSent = 0, m_bytesSent = 0;
};

/** How the radio is, and whom it serves. */
struct StationOptions {
  int port = 4217;
  double rate = 0;      ///< bits a second, with the headers of IP and UDP; 0: as fast as can be
  double timeout = 60;  ///< seconds
  std::size_t receivers = 1;
};

/** Serves receivers, several at once, at one rate for all of them. Nothing is kept of who asks
 * until a whole request shows the cookie that was sent to it. Then kMostAtOnce receivers are kept
 * at most; others ask until there is room. */
class Station {
 public:
  static constexpr std::size_t kMostAtOnce = 16, kMostOfAddress = 4;

  /** \param own What receivers get that do not ask for anything else
   * \throw std::runtime_error the port cannot be used. */
  Station(Maps& maps, const radio::Wish& own, const radio::Seal& seal,
          const StationOptions& options)
      : m_maps(maps),
        m_own(own),
        m_seal(seal),
        m_options(options),
        m_socket(options.port),
        m_silence("nobody asked for the map at port " + std::to_string(port())),
        m_nextSending(Clock::now()),
        m_lastHeard(m_nextSending),
        m_lastBusy(m_nextSending) {}

  int port() const { return m_socket.port(); }
  /** Until so many receivers were served, or the user stops it.
   * \throw std::runtime_error nobody is left who asks: naming the last that fell silent, if any. */
  void serve(const StopRequest& stop) {
    while (!stop.pending() && !isOver()) {
      const auto wait = m_nextSending - Clock::now();
      listen(wait > wait.zero() ? wait : sendOne() ? wait.zero() : kTick);
      forgetSilent();
    }
    for (const Session& s : m_sessions)
      if (s.isServed())
        notes() << s.peer().text() << ": " << s.numSent() << " datagrams, "
                << strict_files::sizeText(s.bytesSent()) << '\n';
  }

 private:
  using Seconds = std::chrono::duration<double>;
  bool isOver() const {
    const auto silence = Clock::now() - std::max(m_lastHeard, m_lastBusy);
    if (numServed() >= m_options.receivers) return silence > kFarewell;
    if (numServed() == m_sessions.size() && silence > Seconds(m_options.timeout))
      throw std::runtime_error(m_silence);
    return false;
  }
  /** Takes the next datagram, if one comes in time. */
  void listen(Clock::duration most) {
    radio::Peer from;
    const auto bytes = m_socket.receive(from, most);
    if (!bytes) return;
    try {
      const auto before = Clock::now();
      const bool isNew = take(from, Datagram::of(m_seal.opened(*bytes)));
      const auto now = Clock::now();
      if (isNew) m_lastHeard = now;
      if (now - before > kTick) m_lastBusy = now;
    } catch (const std::runtime_error& e) {
      details() << from.text() << ": " << e.what() << std::endl;
    }
  }
  /** \return whether a receiver told something new */
  bool take(const radio::Peer& from, const Datagram& datagram) {
    for (Session& session : m_sessions)
      if (session.isOf(from, datagram.stream)) return session.accept(datagram);
    if (datagram.type != Datagram::Type::Request) return false;
    if (m_cookies.isOf(datagram.payload.substr(0, radio::Cookies::kBytes), from, datagram.stream))
      return hasRoomFor(from) && begin(from, datagram);
    if (!m_answer)
      m_answer.emplace(from, Datagram{Datagram::Type::Cookie, datagram.stream,
                                      m_cookies.of(from, datagram.stream)});
    return false;
  }
  bool begin(const radio::Peer& from, const Datagram& request) {
    radio::Wish wish = radio::Wish::of(request.payload.substr(radio::Cookies::kBytes));
    if (wish.weights.empty()) wish.weights = m_own.weights;
    if (wish.solution.empty()) wish.solution = m_own.solution;
    try {
      const auto options = wish.forClasses(m_maps.front().tree().classes(), "weights");
      m_sessions.emplace_front(from, request.stream, m_maps, options);
      return true;
    } catch (const std::exception& e) {
      const std::string why =
          std::string(e.what()).substr(0, semantic_octree::kMaxDatagramBytes / 2);
      notes() << from.text() << ": refused: " << why << std::endl;
      m_answer.emplace(from, Datagram{Datagram::Type::Refusal, request.stream, why});
      return false;
    }
  }
  bool hasRoomFor(const radio::Peer& from) const {
    std::size_t all = 0, ofAddress = 0;
    for (const Session& s : m_sessions) {
      if (s.isServed()) continue;
      ++all;
      ofAddress += s.peer().address.sin_addr.s_addr == from.address.sin_addr.s_addr;
    }
    return all < kMostAtOnce && ofAddress < kMostOfAddress;
  }
  /** Receivers take turns, and so do they and those who ask. \return whether there was anything */
  bool sendOne() {
    m_hasAnswered = m_answer && !m_hasAnswered;
    if (m_hasAnswered) {
      send(m_answer->first, m_answer->second);
      m_answer.reset();
      return true;
    }
    for (auto s = m_sessions.begin(); s != m_sessions.end(); ++s)
      if (const auto datagram = s->next()) {
        send(s->peer(), *datagram);
        m_sessions.splice(m_sessions.end(), m_sessions, s);
        return true;
      }
    return m_answer.has_value();
  }
  void send(const radio::Peer& to, const Datagram& datagram) {
    const std::string bytes = m_seal.sealed(datagram.bytes());
    m_socket.send(to, bytes);
    const double bits = 8.0 * static_cast<double>(bytes.size() + kHeaders);
    m_nextSending = std::max(m_nextSending, Clock::now() - kTick) +
                    std::chrono::duration_cast<Clock::duration>(
                        Seconds(m_options.rate > 0 ? bits / m_options.rate : 0));
  }
  void forgetSilent() {
    const auto since = Clock::now() - std::chrono::duration_cast<Clock::duration>(
                                          Seconds(std::min(m_options.timeout, 1e9)));
    if (m_lastBusy > since) return;
    m_sessions.remove_if([&](const Session& s) {
      if (s.isServed() || s.lastHeard() > since) return false;
      m_silence = "the receiver " + s.peer().text() + " fell silent";
      notes() << m_silence << std::endl;
      m_lastHeard = Clock::now();  // now there is room for who was asking in vain
      return true;
    });
  }
  std::size_t numServed() const {
    return static_cast<std::size_t>(std::count_if(m_sessions.begin(), m_sessions.end(),
                                                  [](const Session& s) { return s.isServed(); }));
  }

  Maps& m_maps;
  radio::Wish m_own;
  radio::Seal m_seal;
  StationOptions m_options;
  radio::UdpSocket m_socket;
  radio::Cookies m_cookies;
  std::list<Session> m_sessions;  ///< whose turn it is first
  /** To one who has no session, and whether the last datagram was such. */
  std::optional<std::pair<radio::Peer, Datagram>> m_answer;
  bool m_hasAnswered = false;
  std::string m_silence;  ///< what to say if nobody is heard
  Clock::time_point m_nextSending, m_lastHeard;
  Clock::time_point m_lastBusy;  ///< then a map was prepared, and nobody heard
};

struct Cli {
  std::vector<fs::path> maps;
  fs::path weights, key;
  double memory = semantic_octree::MapFolderOptions().memory;
  radio::Wish own;
  StationOptions station;

  explicit Cli(CLI::App& app) {
    app.add_option("MAP", maps,
                   std::string("Map to send (") + inputs::kMap +
                       "); of later versions of it, given after it, only what changed is sent")
        ->required();
    addMemoryOption(app, memory);
    app.add_option("--rate", station.rate,
                   "Bits a second, headers of IP and UDP included; without: as fast as possible")
        ->check(isNumber(strict_files::above(0)));
    addNumber(app, "--port", station.port, strict_files::between(0, 65535),
              "UDP port to listen at; 0: any free one, which is printed");
    app.add_option("--weights", weights, "Weights for receivers that send none (YAML)");
    app.add_option("--solution", own.solution,
                   "Name of one solution in the weights; without: the first")
        ->type_name("NAME");
    app.add_option(
        "--key", key,
        "Serve only receivers with this key: a file of 16 bytes or more, the same on both sides");
    addNumber(app, "--receivers", station.receivers, strict_files::above(0),
              "End after this many receivers; up to 16 are served at once, 4 of one address");
    addNumber(app, "--timeout", station.timeout, strict_files::above(0),
              "Forget a receiver that is silent for this long; end if none is left, s");
    app.add_flag_callback("-q,--quiet", beQuiet, "Say nothing but errors");
    app.add_flag_callback("-v,--verbose", beVerbose,
                          "Report datagrams that do not belong to the session");
  }
};

/** \throw std::runtime_error naming a file that cannot be read, before anybody waits for it. */
void open(const Cli& cli, Maps& maps) {
  for (const fs::path& path : cli.maps) {
    inputs::appendMap(maps, path, cli.memory / static_cast<double>(cli.maps.size()));
    if (!maps.back().folder()) continue;
    for (const std::string& problem : maps.back().folder()->problems())
      throw std::runtime_error(problem);
  }
}

int run(Cli& cli) {
  if (!cli.weights.empty()) cli.own.weights = strict_files::readText(cli.weights);
  Maps maps;
  open(cli, maps);
  if (!cli.weights.empty()) cli.own.forClasses(maps.front().tree().classes(), cli.weights.string());
  const StopRequest stop("after this datagram");
  Station station(maps, cli.own, cli.key.empty() ? radio::Seal() : radio::Seal(cli.key),
                  cli.station);
  notes() << "Waiting at port " << station.port() << std::endl;
  station.serve(stop);
  return 0;
}

}  // namespace

}  // namespace semantic_map_send

int main(int argc, char** argv) {
  CLI::App app("Sends a semantic octree map over a thin radio, what matters most first");
  semantic_map_send::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_send::run(cli); });
}
