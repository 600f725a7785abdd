#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_driving/GuideTransitions.h>

#include <optional>
#include <sstream>
#include <string>

using namespace semantic_driving;

namespace {

using What = Action::What;

std::string words(const GuideState& state) {
  std::ostringstream text;
  text << (state.gaveUp ? "gave up" : nameOf(state.target));
  if (state.target == Target::None && !state.gaveUp && state.pathlessSince)
    text << ", since " << *state.pathlessSince;
  if (state.blockedSince) text << ", since " << *state.blockedSince;
  return text.str();
}

std::string words(const Action& action) {
  const char* const names[] = {"go on",         "stop",      "come to rest",
                               "follow",        "seek goal", "seek frontier",
                               "seek recovery", "seek back", "seek nearest"};
  return std::string(names[static_cast<std::size_t>(action.what)]) +
         (action.ahead ? " ahead" : "") + (action.replaces ? ", replacing" : "") +
         (action.orFrontier ? ", or frontier" : "") + (action.last ? ", last" : "");
}

/** A path was looked for in second 10. \param since it is blocked, or there is none */
GuideState doing(Target target, std::optional<double> since = {}) {
  GuideState state;
  state.target = target;
  state.plannedAt = state.changedAt = 10;
  state.hasPlanned = true;
  (target == Target::None ? state.pathlessSince : state.blockedSince) = since;
  return state;
}
GuideState gaveUp() {
  GuideState state = doing(Target::None);
  state.gaveUp = true;
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
  GuideState before;
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
      {"the beginning", doing(Target::None), withoutPath(10), "none", anew},
      {"the beginning, misplaced", doing(Target::None), misplaced(withoutPath(10)), "none",
       "seek recovery"},
      {"nothing happens", doing(Target::Goal), driving(10.9), "goal", "go on"},
      {"a period is over", doing(Target::Goal), driving(11), "goal", "seek goal ahead, replacing"},
      {"no plan from ahead", doing(Target::Goal),
       with(driving(11), [](Look& l) { l.mayPlanAhead = false; }), "goal", "go on"},
      {"somebody steps in", doing(Target::Goal), blocked(11), "goal, since 11", "go on"},
      {"and stays", doing(Target::Goal, 11), blocked(12.9), "goal, since 11", "go on"},
      {"for too long", doing(Target::Goal, 11), blocked(13), "goal, since 11", "come to rest"},
      {"while it is slow", doing(Target::Goal, 11), blocked(13, 0.2), "goal, since 11", instead},
      {"and goes", doing(Target::Goal, 11), driving(10.9), "goal", "go on"},
      {"stuck", doing(Target::Goal), stuck(12), "goal", instead},
      {"stuck, but just planned", doing(Target::Goal), stuck(10.9), "goal", "go on"},
      {"at the goal", doing(Target::Goal), atGoal(10.9), "goal", "go on"},
      {"at the end elsewhere", doing(Target::Goal), ended(10.9), "goal", anew},
      {"at a frontier that is near the goal", doing(Target::Frontier), atGoal(10.9), "frontier",
       anew},
      {"far from a frontier", doing(Target::Frontier), exploring(11, 3.1), "frontier", "go on"},
      {"near a frontier", doing(Target::Frontier), exploring(11, 3), "frontier",
       "seek goal ahead, or frontier"},
      {"the goal is seen", doing(Target::Frontier), driving(11), "frontier", "seek goal ahead"},
      {"still misplaced", doing(Target::Recovery), misplaced(blocked(30)), "recovery",
       "seek goal ahead, replacing"},
      {"just recovered", doing(Target::Recovery), driving(10.5), "recovery", "come to rest"},
      {"just recovered, slowly", doing(Target::Recovery), driving(10.5, 0.1), "recovery", instead},
      {"back, whatever is in the way", doing(Target::Back), blocked(90), "back", "go on"},
      {"back, stuck", doing(Target::Back), stuck(12), "back", instead},
      {"back, at the end", doing(Target::Back), ended(10.9), "back", anew},
      {"back, misplaced at the end", doing(Target::Back), misplaced(ended(11)), "back",
       "seek recovery"},
      {"gave up", gaveUp(), withoutPath(90), "gave up", "stop"}};
  for (const LookRow& row : table) {
    SCOPED_TRACE(row.what);
    const Transition next = transition(row.before, row.look, {});
    EXPECT_EQ(words(next.state), row.after);
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
  const Action goal{What::SeekGoal, false, false, true}, betterGoal{What::SeekGoal, true, true},
      seen{What::SeekGoal, true, false, true};
  const Action frontier{What::SeekFrontier}, another{What::SeekFrontier, true};
  const Action recovery{What::SeekRecovery}, back{What::SeekBack};
  const GuideState idle = doing(Target::None, 19), exploring = doing(Target::Frontier);
  const std::vector<AnswerRow> table = {
      {"a way to the goal", idle, answer(goal, true), "goal", "follow"},
      {"none", idle, answer(goal, false), "none, since 19", "seek frontier"},
      {"none, often", with(idle, back3), answer(goal, false), "none, since 19",
       "seek frontier, last"},
      {"a better one", doing(Target::Goal), answer(betterGoal, true, better), "goal", "follow"},
      {"one as good", doing(Target::Goal), answer(betterGoal, true), "goal", "go on"},
      {"no better one", doing(Target::Goal), answer(betterGoal, false), "goal", "go on"},
      {"there already", doing(Target::Goal), answer(betterGoal, true, empty), "goal", "go on"},
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
      {"no frontier", idle, answer(frontier, false), "none, since 19", "seek back"},
      {"enclosed at the beginning", with(idle, first), answer(frontier, false, enclosed),
       "none, since 19", "seek back"},
      {"enclosed", idle, answer(frontier, false, enclosed), "none, since 19", "stop"},
      {"no frontier, often", with(idle, back3), answer(frontier, false), "none, since 19", "stop"},
      {"for long", doing(Target::None, 16), answer(frontier, false, enclosed), "gave up", "stop"},
      {"a recovery", idle, answer(recovery, true), "recovery", "follow"},
      {"none", idle, answer(recovery, false), "none, since 19", "seek back"},
      {"a way back", doing(Target::Goal, 15), answer(back, true), "back", "follow"},
      {"none", doing(Target::Goal, 15), answer(back, false), "none, since 20", "stop"}};
  for (const AnswerRow& row : table) {
    SCOPED_TRACE(row.what);
    const Transition next = transition(row.before, row.answer);
    EXPECT_EQ(words(next.state), row.after);
    EXPECT_EQ(words(next.action), row.action);
  }
}

TEST(GuideTransitions, WaitForWhatStandsAtTheGoalAndThenSaySo) {
  const GuideOptions options;
  const auto misfit = [](double seconds) {
    return with(driving(seconds), [](Look& l) { l.goalMisfits = true, l.mayStandAtGoal = false; });
  };
  Transition next = transition(doing(Target::Frontier), misfit(10.5), options);
  EXPECT_EQ(words(next.action), "go on");
  next = transition(next.state, misfit(20.4), options);
  EXPECT_NE(words(next.action), "seek nearest");
  const Transition gone = transition(next.state, driving(20.45), options);  // somebody who went on
  EXPECT_NE(words(transition(gone.state, misfit(21), options).action), "seek nearest");
  next = transition(next.state, misfit(20.5), options);
  ASSERT_EQ(words(next.action), "seek nearest");

  const Transition offered = transition(next.state, answer(next.action, false));
  EXPECT_EQ(words(offered.state), "gave up");
  EXPECT_EQ(words(offered.action), "come to rest");
  EXPECT_EQ(words(transition(offered.state, driving(21), options).action), "go on");
  EXPECT_EQ(words(transition(offered.state, ended(22), options).action), "stop");
}

TEST(GuideTransitions, WithoutAPathItWaitsAsLongForWhatStandsAtTheGoal) {
  GuideState state = doing(Target::None, 10);
  state.misfitSince = 12;
  const Answer none{{What::SeekBack}, 20};
  EXPECT_EQ(words(transition(state, none).state), "none, since 10");
  state.misfitSince.reset();
  EXPECT_EQ(words(transition(state, none).state), "gave up");
}

TEST(GuideTransitions, DriveToTheNearestPoseIfItWillDo) {
  const GuideOptions options;
  const auto misfit = [](GuideState& state) { state.misfitSince = 9; };
  Transition next =
      transition(with(doing(Target::Goal), misfit), answer({What::SeekNearest}, true));
  EXPECT_EQ(words(next.action), "come to rest");
  EXPECT_FALSE(next.state.misfitSince);
  next = transition(next.state, ended(21), options);
  EXPECT_EQ(words(next.action), "seek goal, replacing, or frontier");
  next = transition(doing(Target::None), answer({What::SeekNearest}, true));
  EXPECT_EQ(words(next.action), "stop");
  EXPECT_EQ(words(transition(next.state, withoutPath(21), options).action),
            "seek goal, or frontier");
  next = transition(doing(Target::Goal), answer({What::SeekNearest}, false));  // there is none
  EXPECT_EQ(words(next.state), "gave up");
  EXPECT_EQ(next.state.target, Target::None);
}

TEST(GuideTransitions, AnEnclosedVehicleGoesBackOnceAtTheBeginning) {
  Answer none = answer({What::SeekFrontier}, false);
  none.enclosed = true;
  GuideState state;
  EXPECT_EQ(words(transition(state, none).action), "seek back");
  state = transition(state, answer({What::SeekBack}, true)).state;
  EXPECT_EQ(words(transition(state, none).action), "stop");
}

TEST(GuideTransitions, APathThatIsFoundEndsWhatWasBefore) {
  GuideState state = transition(GuideState(), answer({What::SeekBack}, false)).state;
  for (int i = 0; i < GuideState::kMostTimesBack; ++i)
    state = transition(state, answer({What::SeekBack}, true)).state;
  state = transition(state, answer({What::SeekGoal}, true)).state;
  Answer none = answer({What::SeekFrontier}, false);
  none.seconds = 30;
  EXPECT_EQ(words(transition(state, none).action), "seek back");
  none.enclosed = true;
  EXPECT_EQ(words(transition(state, none).action), "stop");
  EXPECT_EQ(words(transition(state, none).state), "none, since 30");
}

TEST(GuideTransitions, CountPathsThatWereLeftBeforeTheirEnd) {
  const GuideOptions options;
  GuideState state = transition(doing(Target::Goal, 11), blocked(13), options).state;
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
  GuideState state = doing(Target::Goal);
  int fromHere = 0;
  for (double seconds = 10; seconds < 20; seconds += 0.1) {
    Look look = driving(seconds, 0);
    look.stoppedFor = seconds - 10;
    Transition next = transition(state, look, options);
    if (next.action.what == What::SeekGoal) {
      fromHere += !next.action.ahead;
      Answer nothingBetter{next.action, seconds};  // from a place ahead
      nothingBetter.found = true;
      next = transition(next.state, nothingBetter);
    }
    state = next.state;
  }
  EXPECT_EQ(fromHere, 3);  // after 4 s, then each 2 s
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
      if (state.target == Target::None) look.finished = true;  // it was told to stop
      look.stoppedFor = *rc::gen::inRange(0, 6), look.left = *rc::gen::inRange(0, 6);
      const bool gaveUp = state.gaveUp;
      Transition next = transition(state, look, options);
      int questions = 0;
      while (next.action.isQuestion()) {
        RC_ASSERT(++questions <= 4);  // goal, frontier, recovery, back
        Answer a{next.action, look.seconds};
        a.found = *rc::gen::inRange(0, 4) == 0, a.better = a.found, a.enclosed = !a.found && i > 40;
        next = transition(next.state, a);
      }
      state = next.state;
      const std::string now = words(state);
      RC_ASSERT(!gaveUp ||
                (now == "gave up" && words(next.action) == (look.finished ? "stop" : "go on")));
      const bool follows = words(next.action) == "follow";
      if (follows && (now == "goal" || now == "frontier")) back = 0;
      if (follows && now == "back") RC_ASSERT(++back <= GuideState::kMostTimesBack);
      if (now != "gave up")  // it may have to come to rest yet
        RC_ASSERT((state.target == Target::None) == (words(next.action) == "stop"));
    }
  }));
}
