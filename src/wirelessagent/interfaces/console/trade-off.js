/** The curve that a decision lies on: what another budget would bring, or what other promises would take. */

import { axis, marks } from "./axis.js";
import { path, worked } from "./api.js";
import { byId, chart, drawing, element, fill, shape, table } from "./dom.js";
import { isUsable } from "./turns.js";
import { digits, human, prefixed, rate, watts } from "./units.js";
import { aimName, heading, say, trouble } from "./words.js";

const LEFT = 48;
const TALL = 220;
const RISE = 24;
const LABELS = 44;
const VARIES = {
  promises: { label: "console.varies_promises", said: "console.trade_off_promises" },
  max_power_w: { label: "console.varies_max_power_w", said: "console.trade_off_max_power_w" },
};
const found = new Map();

const isMet = (decision) => isUsable({ decision });
const isHere = (curve, { at }) => Math.abs(at - curve.here) < 1e-9 * curve.here;
const atOf = ({ varies }, at) => (varies === "promises" ? `× ${digits(at)}` : watts(at));

/** What the curve says, in a sentence. */
function sentence(curve, budget) {
  const met = curve.points.filter(isMet);
  const [first, last] = [met[0], met.at(-1)];
  if (!first) return say("console.trade_off_none");
  const places = { from: atOf(curve, first.at), to: atOf(curve, last.at), low: human(first.value, curve.unit), high: human(last.value, curve.unit) };
  const said = say(VARIES[curve.varies].said, places);
  const beyond = curve.points.find((point) => point.at > last.at && !isMet(point) && point.bound > budget);
  return beyond ? `${said} ${say("console.trade_off_beyond", { at: atOf(curve, beyond.at), bound: human(beyond.bound, curve.unit), budget: watts(budget) })}` : said;
}

/**
 * One picture of a curve: what was found as a line with its points, the proven limit dashed, this decision filled.
 * @param {object} curve as the server answers it
 * @param {{width: number, budget: number}} room `budget` is drawn where power is what is minimised
 */
function curvePicture(curve, { width, budget }) {
  const { points, unit, varies } = curve;
  const limited = varies === "promises";
  const top = 1.08 * Math.max(...points.filter(isMet).map(({ value }) => value), limited ? 1.1 * budget : 0);
  const [most, right, base] = [points.at(-1).at, width - 16, RISE + TALL];
  const x = (at) => LEFT + (at / most) * (right - LEFT);
  const y = (value) => base - (value / top) * TALL;
  const { scale, unit: shownUnit } = prefixed(top, unit);
  const line = (of, read, cls) => shape("path", { class: cls, d: of.map((point, place) => `${place ? "L" : "M"}${x(point.at)} ${y(read(point))}`).join("") });
  const level = (at, text, cls) => [shape("line", { class: cls, x1: LEFT, x2: right, y1: y(at), y2: y(at) }),
    shape("text", { x: LEFT + 8, y: y(at) - 6 }, text)];
  const proven = points.filter(({ bound }) => Number.isFinite(bound) && bound !== null && bound <= top);
  const met = points.filter(isMet);
  const here = met.find((point) => isHere(curve, point));
  return drawing(width, base + LABELS, sentence(curve, budget),
    axis({ left: LEFT, right, base, height: TALL, top: top / scale }),
    shape("text", { x: LEFT, y: 12 }, `${heading(aimName(curve.objective))}, ${shownUnit}`),
    marks(most).map((at) => shape("text", { x: x(at), y: base + 18, "text-anchor": "middle" }, digits(at))),
    shape("text", { x: right, y: base + 38, "text-anchor": "end" }, say(VARIES[varies].label)),
    limited ? level(budget, say("console.limit_is", { budget: watts(budget) }), "edge") : "",
    line(proven, ({ bound }) => bound, "proven"), line(met, ({ value }) => value, "curve"),
    met.map((point) => shape("circle", { class: isHere(curve, point) ? "point here" : "point", cx: x(point.at), cy: y(point.value), r: isHere(curve, point) ? 6 : 4 },
      shape("title", {}, `${atOf(curve, point.at)}: ${human(point.value, unit)}`))),
    here && shape("text", { class: "strong", x: x(here.at) - 10, y: y(here.value) - 10, "text-anchor": "end" }, `${say("console.this_one")} ${human(here.value, unit)}`));
}

function figures(curve) {
  const columns = [say(VARIES[curve.varies].label), heading(aimName(curve.objective)), say("console.proven"), say("label.power_w"), say("label.sum_rate_bps"), say("label.lowest_rate")];
  const rows = curve.points.map((point) => {
    const at = isHere(curve, point) ? `${atOf(curve, point.at)} · ${say("console.this_one")}` : atOf(curve, point.at);
    const shown = isMet(point) ? [watts(point.total_power_w), rate(point.total_rate_bps), rate(point.lowest_rate_bps)] : ["–", "–", "–"];
    return [at, isMet(point) ? human(point.value, curve.unit) : say(`status.${point.status}`), human(point.bound, curve.unit), ...shown];
  });
  return { title: say("console.trade_off"), columns: columns.map(heading), rows, here: curve.points.findIndex((point) => isHere(curve, point)) };
}

/**
 * Open the curve of a turn; it is asked for once.
 * @param {string} session
 * @param {object} turn
 * @param {number} budget the cell's, in W
 */
export async function openTradeOff(session, turn, budget) {
  const body = byId("trade-off-body");
  const at = path`v1/sessions/${session}/turns/${turn.number}/trade-off`;
  body.replaceChildren(element("div", { class: "skeleton tall" }));
  byId("trade-off").showModal();
  try {
    if (!found.has(at)) found.set(at, await worked(at, null, () => {}));
    const curve = found.get(at);
    const most = turn.decision.max_power_w ?? budget;
    fill(body, element("p", {}, sentence(curve, most)),
      curve.points.some(isMet) && chart(say("console.trade_off"), (width) => curvePicture(curve, { width, budget: most })),
      element("p", { class: "note" }, say("console.trade_off_note")), element("div", { class: "more as-table" }, table(figures(curve))));
  } catch (problem) {
    body.replaceChildren(element("p", { class: "problem" }, trouble(problem)));
  }
}
