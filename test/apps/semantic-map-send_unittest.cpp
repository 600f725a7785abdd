// semantic-map-send and semantic-map-receive, as processes on this machine.
#include <gtest/gtest.h>
#include <map_streams/MapStream.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <sys/resource.h>

#include <atomic>
#include <future>
#include <random>
#include <thread>

#include "../semantic_planning/PaintedWorld.h"
#include "RunProgram.h"
#include "SemanticMapCompress.h"
#include "radio/Radio.h"

namespace {

using semantic_octree::Datagram;
using semantic_octree::loadTree;

/** A folder with a map of a road in grass beside a wall, and one that it became later. */
class MapRadio : public FolderTest {
 protected:
  void SetUp() override {
    PaintedWorld world;
    world.floor(-10, 10, -6, 6, PaintedWorld::Grass);
    world.floor(-10, 10, -2, 2, PaintedWorld::Road);
    world.box(-2, 2, 4, 4.4, 0, 2, PaintedWorld::Wall);
    saveTree(world.map(), path("map.semantic"));
    world.box(5, 6, -5, -4.4, 0, 1, PaintedWorld::Wall);
    saveTree(world.map(), path("later.semantic"));
    folder.write("weights.yaml", R"(block_size: 3.2
solutions:
  - {name: road, relevant: {road: 1}, alpha: 0.0002}
  - {name: obstacles, relevant: {wall: 1}, everything: 0.1, alpha: 0.0001}
)");
    folder.write("order.yaml", "best_to_worst: [road, grass, mud]\n");
  }

  /** Runs the sender, and when it waits, an action that knows its port. \return how it ended */
  ProgramRun withSender(const std::string& arguments,
                        const std::function<void(int port)>& action) const {
    folder.write("log", "");
    const std::string command = "cd '" + folder.path().string() +
                                "'; " MSO_BIN_DIR "/semantic-map-send --port 0 " + arguments +
                                " >log 2>&1; status=$?; cat log; exit $status";
    auto run = std::async(std::launch::async, [&] { return runCommand(command); });
    std::size_t at = std::string::npos;
    const std::string waits = "at port ";
    while (at == std::string::npos && run.wait_for(kMoment) != std::future_status::ready)
      at = contains(folder.read("log"), "\n") ? folder.read("log").find(waits) : at;
    if (at != std::string::npos) action(std::stoi(folder.read("log").substr(at + waits.size())));
    return run.get();
  }
  static std::string address(int port) { return "localhost:" + std::to_string(port); }
  ProgramRun ask(int port, const Words& more = {}) const {
    return runProgram("semantic-map-receive",
                      joined({address(port), "-f", "-o", path("r.semantic")}, more));
  }
  ProgramRun receive(int port, const Words& more = {}) const {
    return ask(port, joined({"--weights", path("weights.yaml"), "--solution", "road"}, more));
  }
  /** The tree that semantic-map-compress makes of a map. */
  std::string compressed(const std::string& map, const std::string& solution,
                         const Words& more = {}) const {
    succeeded(runProgram(
        "semantic-map-compress",
        joined({path(map), "--weights", path("weights.yaml"), "-o", path("out"), "-f"}, more)));
    return folder.read("out/" + solution + ".semantic");
  }

  static constexpr std::chrono::milliseconds kMoment{20};
};

/** Somebody at a port of an own who asks for a stream. */
class Asker {
 public:
  Asker(int port, std::uint32_t stream)
      : m_sender(radio::Peer::of("localhost", port)), m_stream(stream) {}
  void send(Datagram::Type type, const std::string& payload) {
    m_socket.send(m_sender, Datagram{type, m_stream, payload}.bytes());
  }
  void ask(const std::string& cookie = std::string(radio::Cookies::kBytes, '\0')) {
    send(Datagram::Type::Request, cookie + kWish);
  }
  /** What comes within a while. */
  std::optional<Datagram> hear() {
    radio::Peer from;
    const auto bytes = m_socket.receive(from, std::chrono::milliseconds(900));
    return bytes ? std::optional(Datagram::of(*bytes)) : std::nullopt;
  }
  /** What the answer is of a whole request with the cookie that the sender gave. */
  std::optional<Datagram> askAsOneShould() {
    ask();
    const auto cookie = hear();
    if (!cookie || cookie->type != Datagram::Type::Cookie) return cookie;
    ask(cookie->payload);
    return hear();
  }

 private:
  inline static const std::string kWish = radio::Wish{
      "{name: a, relevant: {road: 1}, alpha: 0.001, block_size: 3.2}",
      "a",
      {}}.packed();
  radio::Peer m_sender;
  std::uint32_t m_stream;
  radio::UdpSocket m_socket{0};
};

/** A radio between a sender and a receiver. It loses a fifth of what goes either way; a tenth of
 * the rest comes twice, and every fourth changes its place with the next. */
class BadRadio {
 public:
  BadRadio(int port, unsigned seed) : m_sender(radio::Peer::of("localhost", port)), m_random(seed) {
    m_thread = std::thread([this] { carry(); });
  }
  ~BadRadio() {
    m_isOver = true;
    m_thread.join();
  }
  int port() const { return m_toReceiver.port(); }

 private:
  void carry() {
    radio::Peer receiver, from;
    const std::chrono::microseconds wait(200);
    while (!m_isOver) {
      if (const auto bytes = m_toReceiver.receive(receiver, wait))
        send(m_toSender, m_sender, *bytes, m_lateToSender);
      if (const auto bytes = m_toSender.receive(from, wait))
        send(m_toReceiver, receiver, *bytes, m_lateToReceiver);
    }
  }
  using Late = std::optional<std::string>;
  void send(radio::UdpSocket& socket, const radio::Peer& to, const std::string& bytes, Late& late) {
    if (chance(0.2)) return;
    if (!late && chance(0.25)) return void(late = bytes);
    socket.send(to, bytes);
    if (chance(0.1)) socket.send(to, bytes);
    if (late) socket.send(to, *late);
    late.reset();
  }
  bool chance(double p) { return std::uniform_real_distribution(0.0, 1.0)(m_random) < p; }

  radio::Peer m_sender;
  std::mt19937 m_random;
  radio::UdpSocket m_toReceiver{0}, m_toSender{0};
  Late m_lateToReceiver, m_lateToSender;
  std::atomic<bool> m_isOver{false};
  std::thread m_thread;
};

/** Not what differs, which nobody could read. */
void expectSame(const std::string& a, const std::string& b) { EXPECT_TRUE(a == b); }

}  // namespace

TEST(Wish, mayHoldBytesThatAreNoText) {
  const auto wish = radio::Wish::of(radio::Wish{"a: \xff", "\xff", 0.5}.packed());
  EXPECT_EQ(wish.weights, "a: \uFFFD");
  EXPECT_EQ(wish.solution, "\uFFFD");
  EXPECT_EQ(wish.alpha, 0.5);
}

TEST(Wish, isOneDatagramOrRefused) {
  std::mt19937 random(1);
  std::string weights;
  for (int i = 0; i < 900; ++i) weights += static_cast<char>('a' + random() % 26);
  EXPECT_EQ(radio::Wish::of(radio::Wish{weights, "", {}}.packed()).weights, weights);
  for (int i = 0; i < 2000; ++i) weights += static_cast<char>('a' + random() % 26);
  EXPECT_THROW((radio::Wish{weights, "", {}}.packed()), std::runtime_error);
  EXPECT_THROW((radio::Wish{std::string(100000, ' '), "", {}}.packed()), std::runtime_error);
  EXPECT_THROW(radio::Wish::of("hello"), std::runtime_error);
}

TEST(Seal, opensWhatWasSealedWithItsKeyAndNothingElse) {
  const TemporaryFolder folder;
  const radio::Seal none, seal(folder.write("a", "sixteen bytes or more")),
      other(folder.write("b", "sixteen bytes or less"));
  EXPECT_EQ(none.opened(none.sealed("hello")), "hello");
  const std::string sealed = seal.sealed("hello");
  EXPECT_EQ(sealed.size(), 5u + 16);
  EXPECT_EQ(seal.opened(sealed), "hello");
  EXPECT_EQ(seal.opened(seal.sealed("")), "");
  EXPECT_THROW(other.opened(sealed), std::runtime_error);
  for (std::size_t i = 0; i < sealed.size(); ++i) {
    std::string altered = sealed;
    altered[i] ^= 1;
    EXPECT_THROW(seal.opened(altered), std::runtime_error) << i;
    EXPECT_THROW(seal.opened(sealed.substr(0, i)), std::runtime_error) << i;
  }
  // RFC 4231, test case 6.
  const radio::Seal known(folder.write("c", std::string(131, '\xaa')));
  const std::string text = "Test Using Larger Than Block-Size Key - Hash Key First";
  EXPECT_EQ(known.sealed(text), text +
                                    "\x60\xe4\x31\x59\x1e\xe0\xb6\x7f"
                                    "\x0d\x8a\x26\xaa\xcb\xf5\xb7\x7f");
}

TEST_F(MapRadio, eachReceiverHasItsWeightsOverARadioThatLosesAndExchanges) {
  const std::string arguments =
      "--receivers 2 --rate 2000000 --weights weights.yaml --timeout 60 map.semantic";
  const ProgramRun run = withSender(arguments, [&](int port) {
    const BadRadio first(port, 1), second(port, 2);
    auto road = std::async(std::launch::async, [&] {
      return runProgram("semantic-map-receive",
                        {address(first.port()), "-o", path("road.semantic")});
    });
    succeeded(runProgram("semantic-map-receive", {address(second.port()), "--solution", "obstacles",
                                                  "-o", path("obstacles.semantic")}));
    succeeded(road.get());
  });
  EXPECT_EQ(run.status, 0) << run.output;
  expectSame(folder.read("road.semantic"), compressed("map.semantic", "road"));
  expectSame(folder.read("obstacles.semantic"), compressed("map.semantic", "obstacles"));
}

TEST_F(MapRadio, whatChangedFollowsTheFirstMap) {
  const std::string arguments =
      "--weights weights.yaml --solution obstacles --timeout 60 map.semantic later.semantic";
  const ProgramRun run = withSender(arguments, [&](int port) {
    const BadRadio radio(port, 1);
    succeeded(
        runProgram("semantic-map-receive", {address(radio.port()), "-o", path("r.semantic")}));
  });
  EXPECT_EQ(run.status, 0) << run.output;
  expectSame(folder.read("r.semantic"), compressed("later.semantic", "obstacles"));
}

TEST_F(MapRadio, foldersOfTilesAreSentAsWhatTheyHoldWithoutABudgetToSpeakOf) {
  for (const std::string name : {"map", "later"})
    ASSERT_EQ(runProgram("semantic-map-merge",
                         {path(name + ".semantic"), "-o", path(name), "--tiles", "3.2"})
                  .status,
              0);
  const ProgramRun run =
      withSender("--memory 0 --weights weights.yaml --solution obstacles map later",
                 [&](int port) { succeeded(ask(port)); });
  EXPECT_EQ(run.status, 0) << run.output;
  expectSame(folder.read("r.semantic"), compressed("later.semantic", "obstacles"));
}

TEST_F(MapRadio, enoughIsEnough) {
  const ProgramRun run =
      withSender("--rate 4000000 --weights weights.yaml map.semantic", [&](int port) {
        succeeded(ask(port, {"--alpha", "0", "--bytes", "4000"}));
      });
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_LT(loadTree(path("r.semantic")).getNumLeafNodes(),
            loadTree(path("map.semantic")).getNumLeafNodes());
}

TEST_F(MapRadio, theSenderSaysWhatItCannotServe) {
  folder.write("other.yaml", "{name: x, relevant: {lawn: 1}, alpha: 0.1}");
  const ProgramRun run = withSender("map.semantic", [&](int port) {
    const std::string weights = path("weights.yaml");
    expectRefusal(ask(port, {"--weights", path("other.yaml")}), {"refuses: weights:1: ", "lawn"});
    expectRefusal(ask(port), {"neither the sender"});
    expectRefusal(ask(port, {"--weights", weights, "--solution", "rad"}), {"'road'"});
    folder.write("kept.semantic", "of before");
    expectRefusal(runProgram("semantic-map-receive", {address(port), "-o", path("kept.semantic")}),
                  {"is there already"});
    succeeded(ask(port, {"--weights", weights}));
  });
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(folder.read("kept.semantic"), "of before");
}

TEST_F(MapRadio, nobodyThereAndPortsInUseAreSaid) {
  expectRefusal(runProgram("semantic-map-receive",
                           {"localhost:9", "--timeout", "0.3", "-o", path("r.semantic")}),
                {"nobody answers at 127.0.0.1:9"});
  expectRefusal(
      runProgram("semantic-map-send", {path("map.semantic"), "--port", "0", "--timeout", "0.3"}),
      {"nobody asked for the map at port"});
  EXPECT_TRUE(
      contains(runProgram("semantic-map-receive", {"localhost:x", "-o", path("r.semantic")}).errors,
               "expected HOST:PORT"));
  const ProgramRun run = withSender("map.semantic", [&](int port) {
    const std::string used = std::to_string(port);
    expectRefusal(runProgram("semantic-map-send", {path("map.semantic"), "--port", used}),
                  {"port " + used + " cannot be used"});
    succeeded(receive(port));
  });
  EXPECT_EQ(run.status, 0) << run.output;
}

TEST_F(MapRadio, datagramsOfNobodyChangeNothing) {
  const ProgramRun run = withSender("--timeout 20 map.semantic", [&](int port) {
    std::vector<std::unique_ptr<Asker>> askers;
    for (std::uint32_t i = 0; i < 50; ++i)
      askers.push_back(std::make_unique<Asker>(port, 1000 + i));
    for (int i = 0; i < 20; ++i)
      for (const auto& asker : askers) {
        for (int type = 1; type <= 6; ++type)
          asker->send(static_cast<Datagram::Type>(type), std::string(10, '\0'));
        asker->send(Datagram::Type::End, "");
        asker->ask();
      }
    EXPECT_EQ(askers[0]->hear()->bytes().size(), 20u);  // less than was asked
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    succeeded(receive(port));
  });
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run.output.find(" datagrams, "), run.output.rfind(" datagrams, ")) << run.output;
  expectSame(folder.read("r.semantic"), compressed("map.semantic", "road"));
}

TEST_F(MapRadio, whoFallsSilentIsForgottenAlone) {
  const ProgramRun run = withSender("--timeout 1 map.semantic", [&](int port) {
    std::vector<std::unique_ptr<Asker>> askers;
    for (std::uint32_t i = 0; i < 4; ++i) {
      askers.push_back(std::make_unique<Asker>(port, i));
      EXPECT_EQ(askers.back()->askAsOneShould()->type, Datagram::Type::Data);
    }
    EXPECT_FALSE(Asker(port, 4).askAsOneShould());  // of this address there are enough
    succeeded(receive(port));
  });
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(contains(run.output, "fell silent"));
}

TEST_F(MapRadio, aCookieIsOfOneStreamAndOneAddress) {
  const ProgramRun run = withSender("--timeout 1 map.semantic", [&](int port) {
    Asker first(port, 1), second(port, 1);
    first.ask();
    const std::string cookie = first.hear()->payload;
    second.ask(cookie);
    const auto answer = second.hear();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->type, Datagram::Type::Cookie);
    EXPECT_NE(answer->payload, cookie);
  });
  EXPECT_EQ(run.status, 1) << run.output;
}

TEST_F(MapRadio, waitingTakesNoProcessorTime) {
  const auto seconds = [] {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  };
  double begin = 10;
  for (const char* timeout : {"0.01", "2"}) {
    const double before = seconds();
    const ProgramRun run = withSender(std::string("map.semantic --timeout ") + timeout, [](int) {});
    EXPECT_LT(seconds() - before, begin + 0.3) << run.output;
    begin = seconds() - before;
  }
}

TEST_F(MapRadio, onlyWhoHasTheKeyIsHeard) {
  folder.write("key", "sixteen bytes or more");
  folder.write("other", "sixteen bytes or less");
  folder.write("short", "fifteen bytes..");
  const ProgramRun run = withSender("--key key --timeout 20 map.semantic", [&](int port) {
    EXPECT_FALSE(Asker(port, 1).askAsOneShould());
    for (const auto& key : {Words(), {"--key", path("other")}}) {
      Words arguments = key;
      arguments.insert(arguments.end(), {"--timeout", "0.5"});
      expectRefusal(receive(port, arguments), {"nobody answers at"});
    }
    succeeded(receive(port, {"--key", path("key")}));
  });
  EXPECT_EQ(run.status, 0) << run.output;
  expectSame(folder.read("r.semantic"), compressed("map.semantic", "road"));
  EXPECT_TRUE(contains(receive(1, {"--key", path("short")}).errors, "short: a key of 15 bytes"));
}
