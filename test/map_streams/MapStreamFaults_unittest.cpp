// Datagrams and maps that a stream does not take.
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <sstream>

#include "CraftedTreeFile.h"
#include "StreamedMaps.h"
#include "TemporaryFolder.h"

namespace {

using namespace streamed_maps;

TEST(MapStreamFaults, whatDoesNotBelongHereIsRefusedByName) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  sender.setMap(map);
  const Datagram packet = *sender.next();
  std::string bytes = packet.bytes();
  MapReceiver receiver(kStream + 1);
  EXPECT_TRUE(contains(errorOf([&] { receiver.accept(packet); }), "of stream 24301"));
  EXPECT_TRUE(contains(errorOf([&] { sender.accept(packet); }), "expected a receipt"));
  EXPECT_TRUE(contains(errorOf([&] { Datagram::of("hello, world"); }), "another program"));
  EXPECT_TRUE(contains(errorOf([&] { sender.setMap(map); }), "does not have the map"));
  bytes[6] = 9;  // the version
  const auto crc = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(&bytes[4]), static_cast<uInt>(bytes.size() - 4)));
  bytes.replace(0, 4, reinterpret_cast<const char*>(&crc), 4);
  EXPECT_TRUE(contains(errorOf([&] { Datagram::of(bytes); }), "version 9 of the protocol"));
  bytes = packet.bytes();
  bytes.back() ^= 1;
  EXPECT_TRUE(contains(errorOf([&] { Datagram::of(bytes); }), "checksum"));
}

TEST(MapStreamFaults, mapsOfAnotherKindAreNoChange) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  MapReceiver receiver(kStream);
  sender.setMap(map, false);
  for (const Datagram& packet : packetsOf(sender)) receiver.accept(packet);
  sender.accept(receiver.receipt());
  ASSERT_TRUE(sender.isComplete());
  SemanticOcTree other(0.2, numberedClasses(K + 1));
  setAbstraction(other, someOptions(0.01));
  EXPECT_TRUE(contains(errorOf([&] { sender.setMap(other); }), "class table"));
  AbstractionOptions options = someOptions(0.01);
  options.blockSize = 6.4;
  setAbstraction(map, options);
  EXPECT_TRUE(contains(errorOf([&] { sender.setMap(map); }), "blocks"));
  MapSender last(kStream);
  MapReceiver all(kStream);
  last.setMap(map);
  for (const Datagram& packet : packetsOf(last)) all.accept(packet);
  last.accept(all.receipt());
  EXPECT_TRUE(contains(errorOf([&] { last.setMap(map); }), "behind the last one"));
}

TEST(MapStreamFaults, aReceiptThatIsRepeatedTellsNothingNew) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  MapReceiver receiver(kStream);
  sender.setMap(map);
  std::vector<Datagram> receipts;
  for (int i = 0; i < 3; ++i) {
    receiver.accept(*sender.next());
    receipts.push_back(receiver.receipt());
  }
  EXPECT_TRUE(sender.accept(receipts[1]));
  EXPECT_TRUE(sender.accept(receipts[2]));
  for (const Datagram& old : receipts) EXPECT_FALSE(sender.accept(old));
}

/** The description of a stream's map, in one packet, if its first class had another name. */
Datagram withFirstClassNamed(const std::string& name, const std::vector<Datagram>& packets) {
  PacketHeader h = PacketHeader::of(packets[0].payload);
  std::string description;
  for (std::size_t i = 0; i < h.numDescription; ++i)
    description += packets[i].payload.substr(PacketHeader::kBytes);
  StreamDescription d = StreamDescription::of(description);
  std::string content = contentIn(d.kind);
  const auto withSize = [](const std::string& text) {
    return bytesOf(static_cast<std::uint16_t>(text.size())) + text;
  };
  const std::string old = withSize(numberedClasses(K).name(1));
  content.replace(content.find(old), old.size(), withSize(name));
  d.kind = fileAround(content);
  h.numDescription = 1;
  Datagram packet = packets[0];
  packet.payload = h.bytes() + d.compressed();
  return packet;
}

TEST(MapStreamFaults, classNamesWithControlCharactersAreRefused) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  MapSender sender(kStream);
  sender.setMap(map);
  const auto packets = packetsOf(sender);
  MapReceiver receiver(kStream), other(kStream);
  const std::string refusal =
      errorOf([&] { receiver.accept(withFirstClassNamed("road\n!touch x\n", packets)); });
  EXPECT_TRUE(contains(refusal, "the name of class 1, 'road\\x0a!touch x\\x0a'"));
  EXPECT_EQ(errorOf([&] { other.accept(withFirstClassNamed("road, touch x", packets)); }), "");
}

/** A coder's tables with one frequent leaf. */
std::string codingWith(const ClassRecord& record) {
  ByteWriter text;
  text.value(std::uint8_t(1));
  text.value(static_cast<std::uint8_t>(2 + record.count));
  for (const Units units : {Units(0), record.rest}) text.value(units);
  for (int i = 0; i < std::min<int>(record.count, 3); ++i) {
    text.value(record.ids[i]);
    text.value(Units(record.logOdds[i] - record.rest));
  }
  return text.bytes;
}

TEST(MapStreamFaults, frequentRecordsThatCannotBeAreRefused) {
  for (int count = 0; count < 254; ++count) {
    SCOPED_TRACE(count);
    ClassRecord record{};
    record.count = static_cast<std::uint8_t>(count);
    for (int i = 0; i < std::min(count, 3); ++i) record.ids[i] = static_cast<ClassId>(i + 1);
    PartCoder coder(K, 10);
    const std::string error = errorOf([&] { coder.fromText(codingWith(record)); });
    EXPECT_EQ(error.empty(), count <= 3) << error;
  }
}

TEST(MapStreamFaults, statementsThatCannotBeAreRefused) {
  SemanticOcTree map = smallPlace(someOptions(0.01));
  TreeMessage fine = TreeMessage::of(TreeBroadcast(map, kStream).change());
  TreeCopy copy;
  const auto refused = [&](const Calibration& stated) {
    TreeMessage message = fine;
    message.stated = stated;
    EXPECT_EQ(TreeMessage::of(message.bytes()).stated.factors, stated.factors);
    return contains(errorOf([&] { copy.accept(message.bytes()); }), "altered");
  };
  std::vector<double> factors(K, 0.5);
  EXPECT_TRUE(refused({0, 0}));
  EXPECT_TRUE(refused({5, 0}));
  EXPECT_TRUE(refused({1, 0, {1, 2}}));
  EXPECT_FALSE(refused({1, 0, factors}));
  factors[1] = -1;
  ++fine.number;
  EXPECT_TRUE(refused({1, 0, factors}));
}

TEST(MapStreamFaults, aDictionaryThatCannotBeIsRefused) {
  const std::string none(1, '\0'), magic = "\x37\xa4\x30\xec";  // RFC 8878
  EXPECT_EQ(errorOf([&] { PartCoder(K, 10).fromText(none + "any bytes are one"); }), "");
  EXPECT_EQ(errorOf([&] { PartCoder(K, 10).fromText(none + magic + "but not these"); }),
            "altered: a part of a tree that cannot be");
}

TEST(MapStreamFaults, partsOfManyBytesInAFewAreRefused) {
  PartCoder coder(K, 10);
  coder.fromText(std::string(1, '\0'));
  EXPECT_EQ(errorOf([&] { coder.decode(packed(std::string(5 << 20, '\0'))); }),
            "altered: a part of a tree that cannot be");
  std::string lies = packed(std::string(1000, '\0'));
  for (const std::size_t at : {5u, 6u}) lies[at] = '\x7f';  // its size
  EXPECT_NE(errorOf([&] { coder.decode(lies); }), "");
}

TEST(MapStreamFaults, nothingStaysOfADescriptionThatFailed) {
  MapReceiver receiver(kStream);
  const auto accept = [&](std::uint32_t number, const std::string& content) {
    PacketHeader header;
    header.revision = 1;
    header.numDescription = 1;
    header.count = 3;
    header.number = number;
    receiver.accept({Datagram::Type::Data, kStream, header.bytes() + content});
  };
  const auto descriptionOf = [](ClassId id, int numClasses, int rootDepth) {
    ClassRecord record{};
    record.count = 1;
    record.ids[0] = id;
    StreamDescription d;
    d.rootDepth = static_cast<std::uint8_t>(rootDepth);
    d.coding = codingWith(record);
    d.kind = fileOf(SemanticOcTree(0.2, numberedClasses(numClasses)));
    return d.compressed();
  };
  // A leaf with the frequent record, in another cube by each of the descriptions.
  PartCoder coder(K, 10);
  ClassRecord record{};
  record.count = 1;
  record.ids[0] = K;
  coder.fromText(codingWith(record));
  TreePart part;
  part.cell = {0777, 10};
  part.leaves[0] = LeafContent{0, record};
  accept(1, coder.encode({&part}));
  accept(2, "x");
  EXPECT_EQ(errorOf([&] { accept(0, descriptionOf(K, K, 10)); }),
            "altered: a part of a tree that cannot be");
  EXPECT_EQ(receiver.map().getNumLeafNodes(), 1u);
  EXPECT_EQ(errorOf([&] { accept(0, descriptionOf(1, 1, 12)); }),
            "altered: a part of a tree that cannot be");
  EXPECT_EQ(receiver.map().numClasses(), 1);
  EXPECT_EQ(receiver.map().getNumLeafNodes(), 1u);
}

}  // namespace
