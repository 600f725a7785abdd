#pragma once
#include <semantic_driving/GuideTransitions.h>

#include <optional>
#include <sstream>
#include <string>

/** What a guide does, in words. */
namespace guide_words {

using namespace semantic_driving;

inline std::string since(const char* what, const std::optional<double>& since) {
  std::ostringstream text;
  text << what;
  if (since) text << ", since " << *since;
  return text.str();
}

struct InWords {
  std::string operator()(const Idle& a) const { return since("idle", a.since); }
  std::string operator()(const ToGoal& a) const { return since("goal", a.blockedSince); }
  std::string operator()(const ToFrontier& a) const { return since("frontier", a.blockedSince); }
  std::string operator()(const Recovering& a) const {
    return since(a.blind ? "recovery, blind" : "recovery", a.blockedSince);
  }
  std::string operator()(const GoingBack&) const { return "back"; }
  std::string operator()(const GaveUp&) const { return "gave up"; }

  std::string operator()(const GoOn&) const { return "go on"; }
  std::string operator()(const Stop&) const { return "stop"; }
  std::string operator()(const ComeToRest&) const { return "come to rest"; }
  std::string operator()(const Follow&) const { return "follow"; }
  std::string operator()(const SeekGoal& a) const {
    return std::string("seek goal") + (a.from == From::Ahead ? " ahead" : "") +
           (a.replaces ? ", replacing" : "") + (a.orFrontier ? ", or frontier" : "");
  }
  std::string operator()(const SeekFrontier& a) const {
    return std::string("seek frontier") + (a.from == From::Ahead ? " ahead" : "") +
           (a.replaces ? ", replacing" : "") + (a.last ? ", last" : "");
  }
  std::string operator()(const SeekRecovery& a) const {
    return a.blind ? "seek recovery, blind" : "seek recovery";
  }
  std::string operator()(const SeekBack&) const { return "seek back"; }
  std::string operator()(const SeekNearest&) const { return "seek nearest"; }
};

/** An activity or an action in words. */
template <class Variant>
std::string words(const Variant& variant) {
  return std::visit(InWords(), variant);
}

}  // namespace guide_words
