/** Who has which subcarrier with how much power: of the plan, of what is in effect, or of both. */

import { axis } from "./axis.js";
import { fillOf, patterns } from "./colours.js";
import { byId, chart, drawing, element, nothing, shape } from "./dom.js";
import { tabs } from "./tabs.js";
import { changedHands, sum } from "./turns.js";
import { prefixed, watts } from "./units.js";
import { say, userName } from "./words.js";

const LEFT = 40;
const BARS = 120;
const STRIP = 14;
const LEAST = 2.2;
const FEW = 12;
let chosen = "shown";

const nameOf = (decision, user) => (user < 0 ? say("console.nobody") : userName(decision.user_names[user]));

function described(decision, places) {
  const { owner, power_w: power } = decision;
  const total = owner.length;
  const text = say("console.allocation_said", { power: watts(sum(power)), count: owner.filter((user) => user >= 0).length, total });
  return places.length ? `${text} ${say("console.hands", { moved: places.length, total })}` : text;
}

/**
 * One picture of one or two decisions, as wide as it is given.
 * @param {object[]} decisions the one that counts, then the one behind it
 * @param {{width: number, top: number, id: string, moved: number[]}} room
 */
export function allocationPicture(decisions, { width, top, id, moved }) {
  const [decision] = decisions;
  const count = decision.owner.length;
  const cell = Math.max(LEAST, (width - LEFT) / count);
  const base = BARS + 10;
  const right = LEFT + cell * count;
  const height = base + decisions.length * (STRIP + 3) + 16;
  const { scale } = prefixed(top, "W");
  const gap = cell > 8 ? 2 : cell > 4 ? 1 : 0;
  const parts = [patterns(decision.user_names.length, id),
    axis({ left: LEFT, right, base, height: BARS, top: top / scale })];
  decisions.forEach((one, layer) => one.owner.forEach((user, place) => {
    const share = cell / decisions.length;
    const x = LEFT + place * cell;
    const rise = Math.max(one.power_w[place] > 0 ? 1 : 0, (one.power_w[place] / (top || 1)) * BARS);
    const told = { place: place + 1, who: nameOf(one, user), power: watts(one.power_w[place]) };
    const title = shape("title", {}, say("console.bar", told));
    const y = base + 3 + layer * (STRIP + 3);
    parts.push(
      shape("rect", { x: x + gap / 2 + layer * share, y: base - rise, width: Math.max(0.8, share - gap), height: rise,
        rx: cell > 8 ? 2 : 0, fill: fillOf(user, id), class: layer ? "behind" : "bar" }, title),
      shape("rect", { x, y, width: Math.max(0.8, cell - gap / 2), height: STRIP, fill: fillOf(user, id),
        class: layer ? "behind" : "bar" }));
    const middle = { x: x + cell / 2, y: y + 11, class: "owner", "text-anchor": "middle" };
    if (cell >= 15) parts.push(shape("text", middle, user < 0 ? "–" : String(user + 1)));
  }));
  for (const place of moved) {
    const x = LEFT + (place + 0.5) * cell;
    parts.push(shape("path", { class: "moved", d: `M${x - 4} ${height - 2}h8l-4 -7z` }));
  }
  return drawing(right, height, described(decision, moved), parts);
}

/** The highest power on a subcarrier of all these decisions. */
export const highestPower = (decisions) => Math.max(0, ...decisions.flatMap((one) => one.power_w));

/** A legend of users by colour, pattern and number; of many users only those who are served. */
export function userLegend(decisions, id) {
  const names = decisions[0].user_names;
  const served = new Set(decisions.flatMap((one) => one.owner));
  const told = names.map((_, user) => user).filter((user) => names.length <= FEW || served.has(user));
  return element("ul", { class: "users" }, told.map((user) => element("li", {},
    shape("svg", { width: 12, height: 12, "aria-hidden": "true" }, patterns(names.length, `${id}k`),
      shape("rect", { width: 12, height: 12, rx: 2, fill: fillOf(user, `${id}k`) })),
    `${user + 1} ${/^user\s*\d+$/i.test(names[user]) ? "" : userName(names[user])}`.trim())));
}

/**
 * Draw the card.
 * @param {object|null} shown the turn that is looked at
 * @param {object|null} effect the turn in effect
 * @param {string} shownName what the looked-at allocation is called
 */
export function drawAllocation(shown, effect, shownName) {
  const place = byId("allocation-picture");
  const two = shown && effect && shown !== effect && shown.decision.owner.length === effect.decision.owner.length;
  byId("allocation-tabs").hidden = !two;
  if (!shown) {
    byId("allocation-note").textContent = "";
    return place.replaceChildren(nothing(say("console.no_allocation")));
  }
  const of = two ? chosen : "shown";
  const decisions = { shown: [shown.decision], effect: [effect?.decision], both: [shown.decision, effect?.decision] }[of];
  const moved = two ? changedHands(effect.decision, shown.decision) : [];
  const top = highestPower(two ? [shown.decision, effect.decision] : decisions);
  const note = say("console.allocation_note", { unit: prefixed(top, "W").unit });
  byId("allocation-note").textContent = two ? note : `${shownName} · ${note}`;
  if (two) {
    const choices = [["shown", shownName], ["effect", say("console.in_effect")], ["both", say("console.both")]];
    tabs(byId("allocation-tabs"), choices, chosen, "allocation-picture", (name) => {
      chosen = name;
      drawAllocation(shown, effect, shownName);
    });
  }
  place.replaceChildren(
    chart(say("console.allocation"), (width) => allocationPicture(decisions, { width, top, id: "a", moved })),
    element("div", { class: "legend" },
      moved.length ? element("span", { class: "hands" },
        "▲ ", say("console.hands", { moved: moved.length, total: shown.decision.owner.length })) : null,
      of === "both" ? element("span", {}, say("console.both_note", { name: shownName })) : null,
      userLegend(decisions, "al")));
}
