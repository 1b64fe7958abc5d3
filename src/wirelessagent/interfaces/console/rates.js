/** Each user's rate with its 90 % band, against its promise. */

import { axis } from "./axis.js";
import { fillOf, patterns } from "./colours.js";
import { byId, chart, drawing, element, nothing, shape, table } from "./dom.js";
import { NONE, ownedBy, ratesOf, spentOn } from "./turns.js";
import { prefixed, rate, watts } from "./units.js";
import { heading, say, userName } from "./words.js";

const LEFT = 40;
const BARS = 104;
const BASE = BARS + 12;
let opened = false;

/** The highest figure that the rates of these turns reach. */
export const highestRate = (turns) => Math.max(0, ...turns.flatMap(ratesOf)
  .flatMap(({ mean, high, promised }) => [mean, high ?? 0, promised ?? 0]));

/** A rate with its band, where that is wide enough to be written. */
function shownRate({ mean, low, high }) {
  const places = { mean: rate(mean), low: rate(low), high: rate(high) };
  return low === null || places.low === places.high ? places.mean : say("console.rate_band", places);
}

function told(name, one) {
  const { promised } = one;
  const places = { who: userName(name), rate: shownRate(one), promised: rate(promised) };
  return say(promised === null ? "console.rate_bar" : "console.rate_bar_promised", places);
}

/** One picture of a turn's rates. */
export function ratesPicture(turn, { width, top, id }) {
  const names = turn.decision.user_names;
  const slot = Math.min(96, Math.max(8, (width - LEFT) / names.length));
  const right = Math.max(width, LEFT + slot * names.length);
  const { scale } = prefixed(top, "bit/s");
  const y = (value) => BASE - (value / (top || 1)) * BARS;
  const parts = [patterns(names.length, id), axis({ left: LEFT, right, base: BASE, height: BARS, top: top / scale })];
  const wide = slot * 0.56;
  ratesOf(turn).forEach((one, user) => {
    const x = LEFT + user * slot + (slot - wide) / 2;
    const middle = x + wide / 2;
    const height = Math.max(one.mean > 0 ? 1 : 0, BASE - y(one.mean));
    parts.push(shape("rect", { x, y: y(one.mean), width: wide, height, rx: 2, fill: fillOf(user, id), class: "bar" },
      shape("title", {}, told(names[user], one))));
    if (one.low !== null && y(one.low) - y(one.high) >= 1) {
      const ends = `M${middle - 4} ${y(one.low)}h8M${middle - 4} ${y(one.high)}h8`;
      parts.push(shape("path", { class: "band", d: `M${middle} ${y(one.low)}V${y(one.high)}${ends}` }));
    }
    if (one.promised) {
      const level = { y1: y(one.promised), y2: y(one.promised) };
      parts.push(shape("line", { class: "promise", x1: x - slot * 0.12, x2: x + wide + slot * 0.12, ...level }));
    }
    if (slot >= 16 || user % 5 === 4 || !user) {
      const name = slot >= 52 ? userName(names[user]).slice(0, 10) : String(user + 1);
      parts.push(shape("text", { x: middle, y: BASE + 16, "text-anchor": "middle" }, name));
    }
  });
  return drawing(right, BASE + 24, say("console.rates"), parts);
}

/** What each user gets, as a table. */
function figures(turn) {
  const { decision } = turn;
  const columns = ["label.user", "label.subcarriers", "label.power", "label.predicted_band", "console.promised"].map((key) => heading(say(key)));
  const rows = ratesOf(turn).map((one, user) => [userName(decision.user_names[user]), ownedBy(decision, user).length,
    watts(spentOn(decision, user)), shownRate(one), one.promised ? rate(one.promised) : NONE]);
  return { title: say("console.rates"), columns, rows };
}

/** Draw the card of the turn that is looked at. */
export function drawRates(shown) {
  const place = byId("rates-picture");
  if (!shown) {
    byId("rates-note").textContent = "";
    return place.replaceChildren(nothing(say("console.no_rates")));
  }
  const top = highestRate([shown]) * 1.08;
  byId("rates-note").textContent = say("console.rates_note", { unit: prefixed(top, "bit/s").unit });
  place.replaceChildren(chart(say("console.rates"), (width) => ratesPicture(shown, { width, top, id: "r" })),
    element("details", { class: "more as-table", open: opened, toggle: (event) => { opened = event.target.open; } },
      element("summary", {}, say("console.as_table")), table(figures(shown))));
}
