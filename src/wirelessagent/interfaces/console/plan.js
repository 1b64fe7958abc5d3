/** The plan that waits, as what it changes against what is in effect, with one clear button. */

import { byId, element } from "./dom.js";
import { NONE, changedHands, limitRows, sum } from "./turns.js";
import { clock, human, rate, watts } from "./units.js";
import { aimName, heading, say, userName } from "./words.js";

const WORTH_SHOWING = 2e-3;
const MOST_USERS = 5;
const LONG = 24;

function row({ label, before, after }) {
  const was = before && before !== NONE ? [element("del", {}, before), " "] : [];
  return element("tr", {}, element("th", { scope: "row" }, label), element("td", { class: `${before}${after}`.length > LONG ? null : "short" }, was, element("ins", {}, after)));
}

function rateRows(before, after) {
  if (!before || before.rate_bps.length !== after.rate_bps.length) return [];
  return after.rate_bps.flatMap((now, user) => {
    const then = before.rate_bps[user];
    if (Math.abs(now - then) <= WORTH_SHOWING * Math.max(now, then)) return [];
    return [{ label: say("console.rate_of", { who: userName(after.user_names[user]) }), before: rate(then), after: rate(now) }];
  });
}

/**
 * What changes from one turn's decision to another's, as rows and as a list of subcarriers.
 * @param {object|null} effect the turn in effect
 * @param {object} plan the turn that waits
 */
export function difference(effect, plan) {
  const [before, after] = [effect?.decision ?? null, plan.decision];
  const limits = limitRows([effect, plan]).map(({ label, texts: [then, now] }) => ({ label, before: then, after: now, same: then === now }));
  const rates = rateRows(before, after);
  const moved = changedHands(before, after);
  const pair = (label, then, now) => (then === now ? [] : [{ label, before: then, after: now }]);
  const otherAim = before && before.objective !== after.objective;
  const aim = {
    label: say("console.aim"), before: otherAim ? heading(aimName(before.objective)) : "",
    after: heading(aimName(after.objective)),
  };
  return {
    rows: [aim, ...limits.filter((one) => !one.same).map((one) => (one.after === NONE ? { ...one, after: say("console.no_longer") } : one)),
      ...pair(heading(say("part.power")), before ? watts(before.total_power_w) : "", watts(after.total_power_w)),
      ...pair(heading(say("part.rate")), before ? rate(sum(before.rate_bps)) : "", rate(sum(after.rate_bps))),
      ...rates.slice(0, MOST_USERS)],
    more: rates.slice(MOST_USERS),
    hands: before ? say("console.hands_of", { moved: moved.length, total: after.owner.length }) : "",
    moves: moved.map((place) => [place, before.owner[place], after.owner[place]]),
    rest: limits.some((one) => one.same),
  };
}

function movesList(moves, names) {
  const called = (user) => (user < 0 ? say("console.nobody") : userName(names[user]));
  return element("ul", { class: "moves" }, moves.map(([place, from, to]) =>
    element("li", {}, say("console.move", { place: place + 1, from: called(from), to: called(to) }))));
}

/**
 * Draw the card; it goes where nothing waits.
 * @param {{plan: object|null, planTurn: object|null, effect: object|null, canAct: boolean, busy: boolean, people: boolean}} scene
 * @param {{apply: () => void, discard: () => void}} actions
 */
export function drawPlan({ plan, planTurn, effect, canAct, busy, people }, actions) {
  const card = byId("plan-card");
  card.hidden = !plan || !planTurn?.decision;
  if (card.hidden) return;
  const { rows, more, hands, moves, rest } = difference(effect, planTurn);
  byId("plan-note").textContent = say(people && plan.by ? "console.plan_note_by" : "console.plan_note", { time: clock(plan.made_utc), who: plan.by });
  const moving = hands ? element("tr", {}, element("th", { scope: "row" }, say("console.subcarriers_moved")), element("td", {}, hands)) : null;
  const details = moves.length || more.length ? element("details", {},
    element("summary", {}, say("console.more")),
    more.length ? element("table", { class: "rows" }, element("tbody", {}, more.map(row))) : null,
    movesList(moves, planTurn.decision.user_names)) : null;
  byId("plan").replaceChildren(...[
    effect ? null : element("p", { class: "note" }, say("console.nothing_in_effect")),
    element("table", { class: "rows" }, element("tbody", {}, rows.map(row), moving,
      rest ? element("tr", {}, element("th", { scope: "row" }, say("console.everything_else")), element("td", {}, say("console.as_before"))) : null)),
    details,
    planTurn.decision.status === "optimal" || planTurn.decision.gap === null ? null
      : element("p", { class: "note" }, say("console.plan_gap", {
        value: human(planTurn.decision.value, planTurn.decision.unit),
        bound: human(planTurn.decision.bound, planTurn.decision.unit),
      })),
    canAct ? element("div", { class: "buttons" },
      element("button", { type: "button", class: "first", disabled: busy, click: actions.apply }, say("console.apply")),
      element("button", { type: "button", disabled: busy, click: actions.discard }, say("console.discard")))
      : element("p", { class: "note" }, say("console.only_operators_apply"))].filter(Boolean));
}
