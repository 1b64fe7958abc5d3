/** The plan that waits, as what it changes against what is in effect, with one clear button. */

import { button, byId, element, fill, row, rowsTable } from "./dom.js";
import { NONE, changedHands, limitRows, sum } from "./turns.js";
import { clock, rate, watts } from "./units.js";
import { aimName, heading, say, userName } from "./words.js";

const WORTH_SHOWING = 2e-3;
const MOST_USERS = 5;
const LONG = 24;

function change({ label, before, after }) {
  const was = before && before !== NONE ? [element("del", {}, before), " "] : [];
  return row(label, element("td", { class: `${before}${after}`.length <= LONG && "short" }, was, element("ins", {}, after)));
}

function rateRows(before, after) {
  if (!before || before.rate_bps.length !== after.rate_bps.length) return [];
  return after.rate_bps.flatMap((now, user) => {
    const then = before.rate_bps[user];
    if (Math.abs(now - then) <= WORTH_SHOWING * Math.max(now, then)) return [];
    return [{ size: Math.abs(now - then), label: say("console.rate_of", { who: userName(after.user_names[user]) }), before: rate(then), after: rate(now) }];
  }).sort((one, other) => other.size - one.size);
}

/**
 * What changes from one turn's decision to another's, as rows and as a list of subcarriers.
 * @param {object|null} effect the turn in effect
 * @param {object} plan the turn that waits
 */
function difference(effect, plan) {
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
 * @param {{plan: object|null, planTurn: object|null, effect: object|null, canAct: boolean, busy: boolean, people: boolean, stale: boolean}} scene
 * @param {{apply: () => void, discard: () => void, back: (number: number) => void}} actions
 */
export function drawPlan({ plan, planTurn, effect, canAct, busy, people, stale }, actions) {
  const card = byId("plan-card");
  card.hidden = !plan || !planTurn?.decision;
  if (card.hidden) return;
  const { rows, more, hands, moves, rest } = difference(effect, planTurn);
  const waits = stale ? say("console.plan_stale") : say("console.plan_note", { time: clock(plan.until_utc) });
  byId("plan-note").textContent = [people && plan.by, waits].filter(Boolean).join(" · ");
  const note = (text) => element("p", { class: "note" }, text);
  fill(byId("plan"),
    !effect && note(say("console.nothing_in_effect")),
    rowsTable(rows.map(change), hands && row(say("console.subcarriers_moved"), hands),
      rest && row(say("console.everything_else"), say("console.as_before"))),
    moves.length + more.length > 0 && element("details", {}, element("summary", {}, say("console.more")),
      more.length > 0 && rowsTable(more.map(change)), movesList(moves, planTurn.decision.user_names)),
    canAct ? element("div", { class: "buttons" },
      stale ? button(() => actions.back(planTurn.number), { class: "first", disabled: busy }, say("console.ask_again"))
        : button(actions.apply, { class: "first", disabled: busy }, say("console.apply")),
      button(actions.discard, { disabled: busy }, say("console.discard"))) : note(say("console.only_operators_apply")));
}
