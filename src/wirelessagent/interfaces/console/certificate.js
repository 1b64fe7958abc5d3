/** How good a decision is: one bar and one sentence; and what a little more would cost, in plain words. */

import { byId, element, fill, nothing, row, shape } from "./dom.js";
import { isUsable } from "./turns.js";
import { human, percent, signed } from "./units.js";
import { heading, say, userName } from "./words.js";

const STEP_BPS = 1e5;
const WORTH_TELLING = 1e-3;
const DEAREST = 5;

function sentence({ status, value, bound, gap, unit, objective }) {
  if (bound === null || gap === null || !Number.isFinite(gap)) return say("console.certificate_unknown", { value: human(value, unit) });
  const places = { value: human(value, unit), bound: human(bound, unit), gap: percent(gap) };
  if (status === "optimal" || gap <= 1e-9) return say("console.certificate_best", places);
  return say(objective === "min_power" ? "console.certificate_least" : "console.certificate_most", places);
}

function bar({ value, bound, unit }) {
  const [width, top] = [300, Math.max(value, bound) * 1.04];
  const at = (figure) => Math.max(0, (figure / top) * width);
  const label = (figure, text, y) => shape("text",
    { x: Math.min(width, Math.max(90, at(figure))), y, "text-anchor": "end" }, `${text} ${human(figure, unit)}`);
  const told = say("console.certificate_bar", { value: human(value, unit), bound: human(bound, unit) });
  return shape("svg", { class: "gauge", viewBox: `0 0 ${width} 58`, role: "img", "aria-label": told },
    shape("rect", { class: "track", y: 20, width, height: 12, rx: 6 }),
    shape("rect", { class: "filled", y: 20, width: at(value), height: 12, rx: 6 }),
    shape("line", { class: "promise", x1: at(bound), x2: at(bound), y1: 15, y2: 37 }),
    label(bound, say("console.proven"), 10), label(value, say("console.this_one"), 52));
}

/** Draw the certificate of the turn that is looked at. */
export function drawCertificate(turn) {
  const place = byId("certificate");
  if (!turn?.decision) return fill(place, nothing(say("console.no_certificate")));
  const { decision } = turn;
  const drawable = isUsable(turn) && decision.value > 0 && decision.bound > 0 && Number.isFinite(decision.bound);
  fill(place, drawable && bar(decision),
    isUsable(turn) ? element("p", { class: "note" }, sentence(decision))
      : element("p", { class: "note warn", lang: turn.language }, turn.explanation[0] ?? heading(say(`status.${decision.status}`))),
    isUsable(turn) && decision.outage_probability > 0
      && element("p", { class: "note" }, say("console.kept_with", { sure: percent(1 - decision.outage_probability) })));
}

/** What one watt, and 100 kbit/s more for a user, would change at the margin; only what is not nothing. */
function pricesOf(turn) {
  if (!isUsable(turn)) return [];
  const { price_of_power: power, price_of_rate: rates, user_names: names, unit, value, objective } = turn.decision;
  const worth = (change) => Number.isFinite(change) && Math.abs(change) > WORTH_TELLING * Math.abs(value) / 100;
  const rows = (rates ?? []).map((price, user) => [price === null ? 0 : price * STEP_BPS, user]).filter(([change]) => worth(change))
    .sort((one, other) => Math.abs(other[0]) - Math.abs(one[0])).slice(0, DEAREST)
    .map(([change, user]) => [say("console.price_rate", { who: userName(names[user]) }), signed(objective === "min_power" ? change : -Math.abs(change), unit)]);
  if (power && worth(power)) rows.unshift([say("console.price_power"), signed(power, unit)]);
  return rows;
}

/** Draw the prices; the card goes where there are none. */
export function drawPrices(turn) {
  const rows = turn ? pricesOf(turn) : [];
  byId("prices-card").hidden = rows.length === 0;
  fill(byId("prices"), rows.map(([label, change]) => row(label, element("td", { class: "short" }, change))));
}
