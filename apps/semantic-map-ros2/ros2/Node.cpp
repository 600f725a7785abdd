#include "ros2/Node.h"

#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <stdexcept>
#include <utility>

namespace ros2 {

namespace {

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity < 0)
    throw std::runtime_error(what + ": " + dds_strretcode(-entity) + " (Cyclone DDS)");
  return entity;
}

/** \throw std::runtime_error it is no number of a domain */
dds_domainid_t domainOf(const char* text) {
  if (!text || !*text) return 0;
  char* end = nullptr;
  const long id = std::strtol(text, &end, 10);
  if (*end != '\0' || id < 0 || id > 232)
    throw std::runtime_error("ROS_DOMAIN_ID is '" + std::string(text) +
                             "', expected a number from 0 to 232");
  return static_cast<dds_domainid_t>(id);
}

bool is(const char* variable, const char* value) {
  const char* found = std::getenv(variable);
  return found && std::strcmp(found, value) == 0;
}

bool isForThisMachine() {
  return is("ROS_LOCALHOST_ONLY", "1") || is("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST");
}

/** A network beside the loopback, from which Cyclone DDS may choose. */
bool hasNetwork() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return false;
  bool found = false;
  for (const ifaddrs* i = all; i; i = i->ifa_next)
    found |= i->ifa_addr && i->ifa_addr->sa_family == AF_INET && (i->ifa_flags & IFF_UP) &&
             !(i->ifa_flags & IFF_LOOPBACK);
  freeifaddrs(all);
  return found;
}

/** Nodes of this machine alone. Those of Humble are on the loopback, those of Jazzy on the network
 * and look for others on the loopback. Without multicast, which loopback devices may lack,
 * participants are asked for one by one. */
std::string forThisMachine() {
  const std::string network = hasNetwork() ? R"(<NetworkInterface autodetermine="true"/>)" : "";
  return "<General><Interfaces>" + network + R"(<NetworkInterface address="127.0.0.1"/></Interfaces>
  <AllowMulticast>false</AllowMulticast>
</General>
<Discovery>
  <ParticipantIndex>auto</ParticipantIndex>
  <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
  <Peers><Peer address="127.0.0.1"/></Peers>
</Discovery>)";
}

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, QosDeleter>;

constexpr dds_duration_t kPatience = DDS_MSECS(20);  // with readers that do not follow

/** \param typeHash tells nodes from Iron on which definition of the type it is (REP 2016); without,
 * they print a warning for each topic */
QosPointer toDds(const Qos& qos, const std::string& typeHash) {
  QosPointer dds(dds_create_qos());
  const std::string data = "typehash=" + typeHash + ";";
  dds_qset_userdata(dds.get(), data.data(), data.size());
  dds_qset_reliability(
      dds.get(), qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, kPatience);
  dds_qset_durability(dds.get(),
                      qos.latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(dds.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  return dds;
}

dds_entity_t createTopic(const Node& node, const std::string& name, const Type& type) {
  return checked(
      dds_create_topic(node.participant(), &type.dds, ("rt" + name).c_str(), nullptr, nullptr),
      name);
}

}  // namespace

Node::Node(const std::string& name, const Arguments& arguments) : m_name(name) {
  for (const auto& [from, to] : arguments.remappings) {
    if (from == "__node" || from == "__name")
      m_name = to;
    else if (from == "__ns")
      m_namespace = to == "/" ? "" : to;
    else
      m_remappings.emplace_back(from, to);
  }
  topic("~/any");  // the names are right
  for (const auto& [from, to] : m_remappings) expanded(from), expanded(to);
  const dds_domainid_t domain = domainOf(std::getenv("ROS_DOMAIN_ID"));
  if (!std::getenv("CYCLONEDDS_URI") && isForThisMachine()) {
    m_domain = dds_create_domain(domain, forThisMachine().c_str());
    if (m_domain == DDS_RETCODE_PRECONDITION_NOT_MET)  // another node of this process did
      m_domain = 0;
    checked(m_domain, "DDS");
  }
  m_participant = checked(dds_create_participant(domain, nullptr, nullptr), "DDS");
  m_writers = checked(
      dds_create_reader(m_participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr), "DDS");
}

Node::~Node() {
  dds_delete(m_participant);
  if (m_domain) dds_delete(m_domain);
}

std::string Node::expanded(const std::string& name) const {
  std::string full = name;
  if (name.rfind("~/", 0) == 0)
    full = m_namespace + "/" + m_name + name.substr(1);
  else if (name.rfind("/", 0) != 0)
    full = m_namespace + "/" + name;
  static const std::regex kName("(/[A-Za-z_][A-Za-z0-9_]*)+");
  constexpr std::size_t kLongest = 255;  // of DDS; std::regex goes as deep as they are long
  if (full.size() > kLongest || !std::regex_match(full, kName))
    throw std::runtime_error("'" + full + "' is no name of a topic");
  return full;
}

std::string Node::topic(const std::string& name) const {
  const std::string full = expanded(name);
  for (const auto& [from, to] : m_remappings)
    if (expanded(from) == full) return expanded(to);
  return full;
}

std::vector<std::string> Node::look() {
  std::vector<std::string> problems;
  for (Reader* reader : m_readers) {
    reader->adapt();
    reader->sayLosses(problems);
  }
  lookAtWriters(problems);
  const auto isSaid = [this](const std::string& what) { return !m_said.insert(what).second; };
  problems.erase(std::remove_if(problems.begin(), problems.end(), isSaid), problems.end());
  return problems;
}

void Node::lookAtWriters(std::vector<std::string>& problems) {
  void* samples[1] = {nullptr};
  dds_sample_info_t info[1];
  while (dds_take(m_writers, samples, info, 1, 1) > 0) {
    const auto* writer = static_cast<const dds_builtintopic_endpoint_t*>(samples[0]);
    for (const Reader* reader : m_readers) {
      if (!info[0].valid_data || "rt" + reader->m_name != textOf(writer->topic_name)) continue;
      const std::string type = textOf(writer->type_name);
      if (type == reader->m_type.dds.m_typename) continue;
      problems.push_back(reader->m_name + ": somebody writes " + type +
                         ", which is not heard; expected " + reader->m_type.dds.m_typename);
    }
    dds_return_loan(m_writers, samples, 1);
    samples[0] = nullptr;
  }
}

Reader::Reader(Node& node, const std::string& topic, const Type& type, const Qos& qos,
               OnMessage onMessage)
    : m_node(node),
      m_type(type),
      m_qos(qos),
      m_onMessage(std::move(onMessage)),
      m_name(node.topic(topic)),
      m_topic(createTopic(node, m_name, type)) {
  open();
  m_node.m_readers.push_back(this);
}

Reader::~Reader() {
  auto& all = m_node.m_readers;
  all.erase(std::find(all.begin(), all.end(), this));
  close();
  dds_delete(m_topic);
}

void Reader::open() {
  dds_listener_t* listener = dds_create_listener(this);
  dds_lset_data_available(
      listener, [](dds_entity_t reader, void* self) { static_cast<Reader*>(self)->take(reader); });
  m_reader =
      dds_create_reader(m_node.participant(), m_topic, toDds(m_qos, m_type.hash).get(), listener);
  dds_delete_listener(listener);
  checked(m_reader, m_name);
}

void Reader::close() {
  dds_set_listener(m_reader, nullptr);  // waits for a call that runs
  dds_delete(m_reader);
}

void Reader::adapt() {
  dds_requested_incompatible_qos_status_t status;
  if (!m_qos.reliable || dds_get_requested_incompatible_qos_status(m_reader, &status) != 0) return;
  if (status.total_count == 0 || status.last_policy_id != DDS_RELIABILITY_QOS_POLICY_ID) return;
  m_qos.reliable = false;
  close();
  open();
}

void Reader::sayLosses(std::vector<std::string>& problems) const {
  dds_sample_lost_status_t lost;
  if (dds_get_sample_lost_status(m_reader, &lost) == 0 && lost.total_count > 0)
    problems.push_back(m_name +
                       ": messages are lost on the way; a larger net.core.rmem_max of the "
                       "system, or a reliable writer, helps");
  if (m_lacksMemory) problems.push_back(m_name + ": messages are lost: memory is short");
}

void Reader::take(dds_entity_t reader) {
  const auto free = [this](void* m) { dds_sample_free(m, &m_type.dds, DDS_FREE_ALL); };
  for (;;) try {
      void* sample = dds_alloc(m_type.dds.m_size);
      if (!sample) throw std::bad_alloc();
      std::memset(sample, 0, m_type.dds.m_size);
      const std::shared_ptr<void> message(sample, free);
      dds_sample_info_t info;
      if (dds_take(reader, &sample, &info, 1, 1) <= 0) return;
      if (info.valid_data) m_onMessage(message);
    } catch (const std::exception&) {
      m_lacksMemory = true;
    }
}

Writer::Writer(Node& node, const std::string& topic, const Type& type, const Qos& qos)
    : m_topic(createTopic(node, node.topic(topic), type)),
      m_writer(checked(
          dds_create_writer(node.participant(), m_topic, toDds(qos, type.hash).get(), nullptr),
          topic)) {}

Writer::~Writer() {
  dds_delete(m_writer);
  dds_delete(m_topic);
}

bool Writer::write(const void* message) {
  if (dds_write(m_writer, message) != DDS_RETCODE_OK) return false;
  m_hasNewReader = false;
  return true;
}

std::uint32_t Writer::readers() const {
  dds_publication_matched_status_t status;
  const bool isKnown = dds_get_publication_matched_status(m_writer, &status) == 0;
  return isKnown ? status.current_count : 0;
}

bool Writer::hasNewReader() {
  dds_publication_matched_status_t status;
  if (dds_get_publication_matched_status(m_writer, &status) == 0)
    m_hasNewReader |= std::exchange(m_readers, status.total_count) != status.total_count;
  return m_hasNewReader;
}

}  // namespace ros2
