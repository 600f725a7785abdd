// Receives a map from semantic-map-send, over a radio that may lose, exchange and repeat datagrams.
#include <map_streams/MapStream.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/TextFile.h>

#include <chrono>
#include <filesystem>
#include <ostream>
#include <random>

#include "Application.h"
#include "radio/Radio.h"

namespace semantic_map_receive {
namespace {
using std::chrono::milliseconds;

namespace fs = std::filesystem;

struct ReceptionOptions {
  double timeout = 60;    ///< seconds without a word from the sender
  std::size_t bytes = 0;  ///< enough, see semantic_octree::StreamPrefix; 0: all
};

/** The silence before a request or a receipt goes out again. */
constexpr milliseconds kPatience(200);
constexpr std::size_t kPacketsPerReceipt = 16;
/** How often the sender is told that all is there, unless it answers. */
constexpr int kFarewells = 10;

/** Receives one map. */
class Reception {
 public:
  /** \throw std::runtime_error the wish is too long. */
  Reception(const radio::Peer& sender, const radio::Wish& wish, const radio::Seal& seal,
            const ReceptionOptions& options)
      : m_sender(sender),
        m_seal(seal),
        m_options(options),
        m_stream(std::random_device()()),
        m_cookie(radio::Cookies::kBytes, '\0'),
        m_wish(wish.packed()),
        m_socket(0),
        m_receiver(m_stream),
        m_lastHeard(Clock::now()),
        m_lastSent(m_lastHeard - std::chrono::hours(1)) {}

  /** Until it is there, or enough of it, or the user stops it.
   * \throw std::runtime_error the sender is not there, refuses, or falls silent; what came is in
   * receiver() nevertheless. */
  void receive(const StopRequest& stop) {
    while (!stop.pending() && !m_isEnded && !isEnough()) {
      ask();
      listen(std::chrono::milliseconds(50));
      if (Clock::now() - m_lastHeard > std::chrono::duration<double>(m_options.timeout))
        failSilent();
    }
  }
  /** Tells the sender that this is all; it may say so too. */
  void end() {
    for (int i = 0; i < kFarewells && !m_isEnded; ++i) {
      send(m_receiver.isFinished() ? m_receiver.receipt()
                                   : Datagram{Datagram::Type::End, m_stream, ""});
      for (const auto until = Clock::now() + kPatience; Clock::now() < until && !m_isEnded;)
        listen(milliseconds(20));
    }
  }
  const semantic_octree::MapReceiver& receiver() const { return m_receiver; }

 private:
  using Clock = std::chrono::steady_clock;
  using Datagram = semantic_octree::Datagram;
  bool isEnough() const {
    return m_receiver.isFinished() ||
           (m_options.bytes > 0 && m_receiver.prefix().bytes >= m_options.bytes);
  }
  /** Waits for a datagram and takes it. \return whether one came */
  bool listen(milliseconds timeout) {
    radio::Peer from;
    const auto bytes = m_socket.receive(from, timeout);
    if (!bytes || !(from == m_sender)) return false;
    std::optional<Datagram> datagram;
    try {
      datagram = Datagram::of(m_seal.opened(*bytes));
      if (datagram->stream != m_stream) return false;
    } catch (const std::runtime_error& e) {
      details() << from.text() << ": " << e.what() << std::endl;
      return false;
    }
    m_lastHeard = Clock::now();
    take(*datagram);
    return true;
  }
  void take(const Datagram& datagram) {
    if (datagram.type == Datagram::Type::Refusal)
      throw std::runtime_error("the sender " + m_sender.text() + " refuses: " + datagram.payload);
    if (datagram.type == Datagram::Type::End) m_isEnded = true;
    if (datagram.type == Datagram::Type::Cookie && datagram.payload != m_cookie) {
      m_cookie = datagram.payload;
      m_lastSent = {};  // asks at once
    }
    if (datagram.type != Datagram::Type::Data) return;
    const bool wasComplete = m_receiver.isComplete();
    m_receiver.accept(datagram);
    ++m_numUnacknowledged;
    if (m_receiver.isComplete() && !wasComplete) send(m_receiver.receipt());
  }
  void ask() {
    const bool isDue = Clock::now() - m_lastSent > kPatience;
    const bool isAnswered = m_receiver.numExpected() > 0;
    if (!isDue && !(isAnswered && m_numUnacknowledged >= kPacketsPerReceipt)) return;
    send(isAnswered ? m_receiver.receipt()
                    : Datagram{Datagram::Type::Request, m_stream, m_cookie + m_wish});
    m_numUnacknowledged = 0;
    m_lastSent = Clock::now();
  }
  void send(const Datagram& datagram) { m_socket.send(m_sender, m_seal.sealed(datagram.bytes())); }
  [[noreturn]] void failSilent() const {
    if (m_receiver.numExpected() == 0)
      throw std::runtime_error("nobody answers at " + m_sender.text());
    throw std::runtime_error("the sender " + m_sender.text() + " fell silent after " +
                             std::to_string(m_receiver.numPackets()) + " of " +
                             std::to_string(m_receiver.numExpected()) + " packets");
  }

  radio::Peer m_sender;
  radio::Seal m_seal;
  ReceptionOptions m_options;
  std::uint32_t m_stream;
  std::string m_cookie, m_wish;  ///< of a request
  radio::UdpSocket m_socket;
  semantic_octree::MapReceiver m_receiver;
  bool m_isEnded = false;
  std::size_t m_numUnacknowledged = 0;
  Clock::time_point m_lastHeard, m_lastSent;
};

struct Cli {
  std::string sender;
  fs::path output, weights, key;
  radio::Wish wish;
  ReceptionOptions reception;
  Outputs outputs;

  explicit Cli(CLI::App& app) : outputs(app) {
    app.add_option("SENDER", sender,
                   "Where semantic-map-send is, HOST:PORT; the port may be left out (4217)")
        ->required();
    outputs.add(app, output, "FILE", "The map to write (.semantic)")->required();
    app.add_option("--weights", weights, "Weights of classes (YAML); without: the sender's");
    app.add_option("--solution", wish.solution,
                   "Name of one solution in the weights; without: the first")
        ->type_name("NAME");
    app.add_option("--alpha", wish.alpha, "The price of detail, instead of the weights' own")
        ->check(isNumber(strict_files::atLeast(0)));
    app.add_option("--bytes", reception.bytes,
                   "End after this many bytes of the map: a coarse map, for the rest is detail")
        ->check(isNumber(strict_files::above(0)));
    app.add_option(
        "--key", key,
        "Listen only to a sender with this key: a file of 16 bytes or more, the same on both "
        "sides");
    addNumber(app, "--timeout", reception.timeout, strict_files::above(0),
              "End when the sender is silent for this long, s");
    app.add_flag_callback("-v,--verbose", beVerbose,
                          "Report datagrams that do not belong to the session");
  }
};

radio::Peer peerOf(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return radio::Peer::of(text, 4217);
  const std::string port = text.substr(colon + 1);
  const bool isNumber =
      !port.empty() && port.size() < 6 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!isNumber || std::stoi(port) < 1 || std::stoi(port) > 65535)
    throw std::runtime_error("expected HOST:PORT with a port from 1 to 65535, found '" + text +
                             "'");
  return radio::Peer::of(text.substr(0, colon), std::stoi(port));
}

void save(const Reception& reception, const fs::path& file) {
  const semantic_octree::MapReceiver& receiver = reception.receiver();
  if (!receiver.hasMap()) return;
  semantic_octree::saveTree(receiver.map(), file.string());
  notes() << file.string() << ": " << receiver.numLeaves() << " leaves, " << receiver.numPackets()
          << " of " << receiver.numExpected() << " packets" << std::endl;
}

int run(Cli& cli) {
  cli.outputs.check({cli.output});
  if (!cli.weights.empty()) cli.wish.weights = strict_files::readText(cli.weights);
  const StopRequest stop("after this packet");
  Reception reception(peerOf(cli.sender), cli.wish,
                      cli.key.empty() ? radio::Seal() : radio::Seal(cli.key), cli.reception);
  try {
    reception.receive(stop);
  } catch (const std::runtime_error&) {
    save(reception, cli.output);
    throw;
  }
  save(reception, cli.output);
  reception.end();
  return 0;
}

}  // namespace

}  // namespace semantic_map_receive

int main(int argc, char** argv) {
  CLI::App app("Receives a semantic octree map from semantic-map-send over a thin radio");
  semantic_map_receive::Cli cli(app);
  return runApplication(app, argc, argv, [&] { return semantic_map_receive::run(cli); });
}
