#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_driving/GuideTransitions.h>

#include <optional>
#include <sstream>
#include <string>

using namespace semantic_driving;

namespace {

std::string since(const char* what, const std::optional<double>& since) {
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

/** A path was looked for in second 10. */
GuideState doing(const Activity& activity) {
  GuideState state;
  state.activity = activity;
  state.plannedAt = state.changedAt = 10;
  state.hasPlanned = true;
  return state;
}

/** On the way with 1 m/s, at rest it is 0. */
Look driving(double seconds, double speed = 1) {
  Look look;
  look.seconds = seconds;
  look.speed = speed;
  look.left = 20;
  look.hasPath = true;
  look.finished = false;
  return look;
}

template <class Change>
Look with(Look look, Change change) {
  change(look);
  return look;
}
Look blocked(double seconds, double speed = 1) {
  return with(driving(seconds, speed), [](Look& l) { l.blocked = true; });
}
Look stuck(double seconds) {
  return with(driving(seconds, 0), [](Look& l) { l.stoppedFor = 4; });
}
Look ended(double seconds) {
  return with(driving(seconds, 0), [](Look& l) { l.finished = true, l.left = 0; });
}
Look atGoal(double seconds) {
  return with(ended(seconds), [](Look& l) { l.nearGoal = true; });
}
Look misplaced(Look look) {
  return with(look, [](Look& l) { l.mayPlan = false; });
}
/** The goal is not known yet. */
Look exploring(double seconds, double left) {
  return with(driving(seconds), [left](Look& l) { l.mayStandAtGoal = false, l.left = left; });
}
Look withoutPath(double seconds) {
  Look look;
  look.seconds = seconds;
  return look;
}

struct LookRow {
  const char* what;
  Activity before;
  Look look;
  std::string after, action;
};

struct AnswerRow {
  const char* what;
  GuideState before;
  Answer answer;
  std::string after, action;
};

Answer answer(const Action& question, bool found) { return {question, 20, found}; }
template <class Change>
Answer answer(const Action& question, bool found, Change change) {
  Answer a = answer(question, found);
  change(a);
  return a;
}
GuideState with(GuideState state, void (*change)(GuideState&)) {
  change(state);
  return state;
}

}  // namespace

TEST(GuideTransitions, AfterALook) {
  const std::string anew = "seek goal, or frontier", instead = "seek goal, replacing, or frontier";
  const std::vector<LookRow> table = {
      {"the beginning", Idle{}, withoutPath(10), "idle", anew},
      {"the beginning, misplaced", Idle{}, misplaced(withoutPath(10)), "idle", "seek recovery"},
      {"nothing happens", ToGoal{}, driving(10.9), "goal", "go on"},
      {"a period is over", ToGoal{}, driving(11), "goal", "seek goal ahead, replacing"},
      {"no plan from ahead", ToGoal{}, with(driving(11), [](Look& l) { l.mayPlanAhead = false; }),
       "goal", "go on"},
      {"somebody steps in", ToGoal{}, blocked(11), "goal, since 11", "go on"},
      {"and stays", ToGoal{11}, blocked(12.9), "goal, since 11", "go on"},
      {"for too long", ToGoal{11}, blocked(13), "goal, since 11", "come to rest"},
      {"while it is slow", ToGoal{11}, blocked(13, 0.2), "goal, since 11", instead},
      {"and goes", ToGoal{11}, driving(10.9), "goal", "go on"},
      {"stuck", ToGoal{}, stuck(12), "goal", instead},
      {"stuck, but just planned", ToGoal{}, stuck(10.9), "goal", "go on"},
      {"at the goal", ToGoal{}, atGoal(10.9), "goal", "go on"},
      {"at the end elsewhere", ToGoal{}, ended(10.9), "goal", anew},
      {"at a frontier that is near the goal", ToFrontier{}, atGoal(10.9), "frontier", anew},
      {"far from a frontier", ToFrontier{}, exploring(11, 3.1), "frontier", "go on"},
      {"near a frontier", ToFrontier{}, exploring(11, 3), "frontier",
       "seek goal ahead, or frontier"},
      {"the goal is seen", ToFrontier{}, driving(11), "frontier", "seek goal ahead"},
      {"still misplaced", Recovering{}, misplaced(blocked(30)), "recovery",
       "seek goal ahead, replacing"},
      {"just recovered", Recovering{}, driving(10.5), "recovery", "come to rest"},
      {"just recovered, slowly", Recovering{}, driving(10.5, 0.1), "recovery", instead},
      {"blind, it drives to the end", Recovering{true, {}}, driving(10.5), "recovery, blind",
       "go on"},
      {"blind, blocked", Recovering{true, {}}, blocked(11), "recovery, blind, since 11", "go on"},
      {"back, whatever is in the way", GoingBack{}, blocked(90), "back", "go on"},
      {"back, stuck", GoingBack{}, stuck(12), "back", instead},
      {"back, at the end", GoingBack{}, ended(10.9), "back", anew},
      {"back, misplaced at the end", GoingBack{}, misplaced(ended(11)), "back", "seek recovery"},
      {"gave up", GaveUp{}, withoutPath(90), "gave up", "stop"}};
  for (const LookRow& row : table) {
    SCOPED_TRACE(row.what);
    const Transition next = transition(doing(row.before), row.look, {});
    EXPECT_EQ(words(next.state.activity), row.after);
    EXPECT_EQ(words(next.action), row.action);
  }
}

TEST(GuideTransitions, AfterAnAnswer) {
  const auto back3 = [](GuideState& s) { s.timesBack = 3; };
  const auto first = [](GuideState& s) { s.hasPlanned = false; };
  const auto enclosed = [](Answer& a) { a.enclosed = true; };
  const auto better = [](Answer& a) { a.better = true; };
  const auto empty = [](Answer& a) { a.empty = a.better = true; };
  const auto shunting = [](bool early) {
    return [early](Answer& a) { a.shunts = true, a.early = early; };
  };
  const SeekGoal goal{}, betterGoal{From::Ahead, true, false}, seen{From::Ahead, false, true};
  const SeekFrontier frontier{}, another{From::Ahead, false, false};
  const GuideState idle = doing(Idle{19}), exploring = doing(ToFrontier{});
  const std::vector<AnswerRow> table = {
      {"a way to the goal", idle, answer(goal, true), "goal", "follow"},
      {"none", idle, answer(goal, false), "idle, since 19", "seek frontier"},
      {"none, often", with(idle, back3), answer(goal, false), "idle, since 19",
       "seek frontier, last"},
      {"a better one", doing(ToGoal{}), answer(betterGoal, true, better), "goal", "follow"},
      {"one as good", doing(ToGoal{}), answer(betterGoal, true), "goal", "go on"},
      {"no better one", doing(ToGoal{}), answer(betterGoal, false), "goal", "go on"},
      {"there already", doing(ToGoal{}), answer(betterGoal, true, empty), "goal", "go on"},
      {"a goal at last", exploring, answer(seen, true), "goal", "follow"},
      {"no goal yet", exploring, answer(seen, false), "frontier", "seek frontier ahead"},
      {"another frontier", exploring, answer(another, true), "frontier", "follow"},
      {"one with a change of gear, early", exploring, answer(another, true, shunting(true)),
       "frontier", "go on"},
      {"and when it is there", exploring, answer(another, true, shunting(false)), "frontier",
       "follow"},
      {"and at rest", idle, answer(frontier, true, shunting(true)), "frontier", "follow"},
      {"no other frontier", exploring, answer(another, false), "frontier", "go on"},
      {"a frontier", idle, answer(frontier, true), "frontier", "follow"},
      {"no frontier", idle, answer(frontier, false), "idle, since 19", "seek back"},
      {"nor one at the beginning", with(doing(Idle{}), first), answer(frontier, false), "idle",
       "seek recovery, blind"},
      {"enclosed", idle, answer(frontier, false, enclosed), "idle, since 19", "stop"},
      {"no frontier, often", with(idle, back3), answer(frontier, false), "idle, since 19", "stop"},
      {"for long", doing(Idle{16}), answer(frontier, false, enclosed), "gave up", "stop"},
      {"a recovery", idle, answer(SeekRecovery{false}, true), "recovery", "follow"},
      {"a blind one", idle, answer(SeekRecovery{true}, true), "recovery, blind", "follow"},
      {"none", idle, answer(SeekRecovery{false}, false), "idle, since 19", "seek back"},
      {"a way back", doing(ToGoal{15}), answer(SeekBack{}, true), "back", "follow"},
      {"none", doing(ToGoal{15}), answer(SeekBack{}, false), "idle, since 20", "stop"}};
  for (const AnswerRow& row : table) {
    SCOPED_TRACE(row.what);
    const Transition next = transition(row.before, row.answer);
    EXPECT_EQ(words(next.state.activity), row.after);
    EXPECT_EQ(words(next.action), row.action);
  }
}

TEST(GuideTransitions, WaitForWhatStandsAtTheGoalAndThenSaySo) {
  const GuideOptions options;
  const auto misfit = [](double seconds) {
    return with(driving(seconds), [](Look& l) { l.goalMisfits = true, l.mayStandAtGoal = false; });
  };
  Transition next = transition(doing(ToFrontier{}), misfit(10.5), options);
  EXPECT_EQ(words(next.action), "go on");
  next = transition(next.state, misfit(20.4), options);
  EXPECT_NE(words(next.action), "seek nearest");
  const Transition gone = transition(next.state, driving(20.45), options);  // somebody who went on
  EXPECT_NE(words(transition(gone.state, misfit(21), options).action), "seek nearest");
  next = transition(next.state, misfit(20.5), options);
  ASSERT_EQ(words(next.action), "seek nearest");

  const Transition offered = transition(next.state, answer(next.action, false));
  EXPECT_EQ(words(offered.state.activity), "gave up");
  EXPECT_EQ(words(offered.action), "come to rest");
  EXPECT_EQ(words(transition(offered.state, driving(21), options).action), "go on");
  EXPECT_EQ(words(transition(offered.state, ended(22), options).action), "stop");
}

TEST(GuideTransitions, WithoutAPathItWaitsAsLongForWhatStandsAtTheGoal) {
  GuideState state = doing(Idle{10.0});
  state.misfitSince = 12;
  const Answer none{SeekBack{}, 20};
  EXPECT_EQ(words(transition(state, none).state.activity), "idle, since 10");
  state.misfitSince.reset();
  EXPECT_EQ(words(transition(state, none).state.activity), "gave up");
}

TEST(GuideTransitions, DriveToTheNearestPoseIfItWillDo) {
  const GuideOptions options;
  Transition next = transition(doing(ToGoal{}), answer(SeekNearest{}, true));
  EXPECT_EQ(words(next.action), "come to rest");
  next = transition(next.state, ended(21), options);
  EXPECT_EQ(words(next.action), "seek goal, replacing, or frontier");
  next = transition(doing(Idle{}), answer(SeekNearest{}, true));
  EXPECT_EQ(words(next.action), "stop");
  EXPECT_EQ(words(transition(next.state, withoutPath(21), options).action),
            "seek goal, or frontier");
  next = transition(doing(ToGoal{}), answer(SeekNearest{}, false));  // there is none
  EXPECT_EQ(words(next.state.activity), "gave up");
}

TEST(GuideTransitions, CountPathsThatWereLeftBeforeTheirEnd) {
  const GuideOptions options;
  GuideState state = transition(doing(ToGoal{11}), blocked(13), options).state;
  EXPECT_EQ(state.replans, 0);
  const Transition rest = transition(state, ended(14), options);  // at rest, at the path's new end
  EXPECT_EQ(words(rest.action), "seek goal, replacing, or frontier");
  state = transition(rest.state, answer(rest.action, true)).state;
  EXPECT_EQ(state.replans, 1);
  const Transition end = transition(state, ended(20), options);
  EXPECT_EQ(transition(end.state, answer(end.action, true)).state.replans, 1);
}

TEST(GuideTransitions, AVehicleThatDoesNotGetOnLooksFromWhereItStands) {
  const GuideOptions options;
  GuideState state = doing(ToGoal{});
  int fromHere = 0;
  for (double seconds = 10; seconds < 20; seconds += 0.1) {
    Look look = driving(seconds, 0);
    look.stoppedFor = seconds - 10;
    Transition next = transition(state, look, options);
    if (const auto* goal = std::get_if<SeekGoal>(&next.action)) {
      fromHere += goal->from == From::Here;
      Answer nothingBetter{next.action, seconds};  // from a place ahead
      nothingBetter.found = true;
      next = transition(next.state, nothingBetter);
    }
    state = next.state;
  }
  EXPECT_EQ(fromHere, 3);  // after 4 s, then each 2 s
}

TEST(GuideTransitions, AnEnclosedVehicleLooksForABlindRecoveryOnce) {
  const GuideOptions options;
  GuideState state;
  const auto enclosed = [](Answer& a) { a.enclosed = true; };
  for (const char* expected : {"seek recovery, blind", "stop"}) {
    state = transition(state, withoutPath(1), options).state;
    const Transition next = transition(state, answer(SeekFrontier{}, false, enclosed));
    EXPECT_EQ(words(next.action), expected);
    state = next.state;
  }
}

TEST(GuideTransitions, WhateverHappensQuestionsEndAndTheVehicleGoesBackThreeTimesAtMost) {
  EXPECT_TRUE(rc::check([] {
    const GuideOptions options;
    GuideState state;
    int back = 0;
    for (int i = 0; i < 60; ++i) {
      Look look = driving(i, *rc::gen::inRange(0, 2));
      look.finished = *rc::gen::arbitrary<bool>(), look.nearGoal = *rc::gen::arbitrary<bool>();
      look.goalMisfits = *rc::gen::inRange(0, 10) > 0;
      look.blocked = *rc::gen::arbitrary<bool>(), look.mayPlan = *rc::gen::arbitrary<bool>();
      if (state.target() == Target::None) look.finished = true;  // it was told to stop
      look.stoppedFor = *rc::gen::inRange(0, 6), look.left = *rc::gen::inRange(0, 6);
      const bool gaveUp = std::holds_alternative<GaveUp>(state.activity);
      Transition next = transition(state, look, options);
      int questions = 0;
      while (words(next.action).rfind("seek", 0) == 0) {
        RC_ASSERT(++questions <= 4);  // goal, frontier, recovery, back
        Answer a{next.action, look.seconds};
        a.found = *rc::gen::inRange(0, 4) == 0, a.better = a.found, a.enclosed = !a.found && i > 40;
        next = transition(next.state, a);
      }
      state = next.state;
      const std::string now = words(state.activity);
      RC_ASSERT(!gaveUp ||
                (now == "gave up" && words(next.action) == (look.finished ? "stop" : "go on")));
      const bool follows = words(next.action) == "follow";
      if (follows && (now == "goal" || now == "frontier")) back = 0;
      if (follows && now == "back") RC_ASSERT(++back <= GuideState::kMostTimesBack);
      if (now != "gave up")  // it may have to come to rest yet
        RC_ASSERT((state.target() == Target::None) == (words(next.action) == "stop"));
    }
  }));
}
