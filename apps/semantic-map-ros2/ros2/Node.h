#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "ros2/Arguments.h"
#include "ros2/Messages.h"

namespace ros2 {

class Reader;

/** What ROS's profiles ask of DDS. */
struct Qos {
  bool reliable = true;  ///< a reader that asks for it hears best-effort writers, too, see Reader
  bool latched = false;  ///< who comes late gets the last messages (transient local)
  int depth = 10;        ///< messages that are kept
};

/** A citizen of a ROS 2 system that needs no ROS: topics and types have the names that ROS's
 * middleware gives them. The domain is that of ROS_DOMAIN_ID; with ROS_LOCALHOST_ONLY=1 or
 * ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST nothing leaves this machine; CYCLONEDDS_URI counts. */
class Node {
 public:
  /** \param arguments remap the topics, the name (__node) and the namespace (__ns)
   * \throw std::runtime_error what is wrong with a name, the domain or the network. */
  Node(const std::string& name, const Arguments& arguments);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /** A topic's full name: "/robot/points" of "points", in the namespace and remapped; "~/x" is in
   * the node's own namespace. \throw std::runtime_error it is no name of a topic */
  std::string topic(const std::string& name) const;
  dds_entity_t participant() const { return m_participant; }

  /** To be called now and then: readers adapt to their writers. \return what was not said before:
   * others who write another type to a topic that is read here, and messages that were lost. */
  std::vector<std::string> look();

 private:
  friend class Reader;
  std::string expanded(const std::string& name) const;
  void lookAtWriters(std::vector<std::string>& problems);

  std::string m_name, m_namespace;
  std::vector<std::pair<std::string, std::string>> m_remappings;
  dds_entity_t m_domain = 0, m_participant = 0, m_writers = 0;
  std::vector<Reader*> m_readers;
  std::set<std::string> m_said;
};

/** Hears a topic, whatever its message. A reliable one becomes best-effort when it meets a writer
 * that is. */
class Reader {
 public:
  /** Is called by DDS's threads. */
  using OnMessage = std::function<void(std::shared_ptr<const void>)>;
  Reader(Node& node, const std::string& topic, const Type& type, const Qos& qos,
         OnMessage onMessage);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  const std::string& name() const { return m_name; }

 private:
  friend class Node;
  void open();
  void close();
  void adapt();
  void sayLosses(std::vector<std::string>& problems) const;
  void take(dds_entity_t reader);

  Node& m_node;
  Type m_type;
  Qos m_qos;
  OnMessage m_onMessage;
  std::string m_name;  ///< of the topic, in full
  dds_entity_t m_topic = 0, m_reader = 0;
  std::atomic<bool> m_lacksMemory{false};
};

/** Hears messages of a topic. */
template <class Message>
class Subscription {
 public:
  /** \param onMessage is called by DDS's threads */
  Subscription(Node& node, const std::string& topic, const Qos& qos,
               std::function<void(std::shared_ptr<const Message>)> onMessage)
      : m_reader(node, topic, typeOf<Message>(), qos,
                 [onMessage = std::move(onMessage)](std::shared_ptr<const void> message) {
                   onMessage(std::static_pointer_cast<const Message>(std::move(message)));
                 }) {}
  const std::string& name() const { return m_reader.name(); }

 private:
  Reader m_reader;
};

/** Writes a topic, whatever its message. */
class Writer {
 public:
  Writer(Node& node, const std::string& topic, const Type& type, const Qos& qos);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /** Waits a moment at most for readers that do not follow. \return whether it was written */
  bool write(const void* message);
  /** How many read it now. */
  std::uint32_t readers() const;
  bool isRead() const { return readers() > 0; }
  /** Whether a reader came for whom nothing was written yet. */
  bool hasNewReader();

 private:
  dds_entity_t m_topic = 0, m_writer = 0;
  std::uint32_t m_readers = 0;  ///< that ever came
  bool m_hasNewReader = false;
};

/** Writes messages of a topic. */
template <class Message>
class Publication : public Writer {
 public:
  Publication(Node& node, const std::string& topic, const Qos& qos)
      : Writer(node, topic, typeOf<Message>(), qos) {}
  bool write(const Message& message) { return Writer::write(&message); }
};

}  // namespace ros2
