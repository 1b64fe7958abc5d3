/** Decisions side by side: their figures, their allocations on one scale, their rates on one scale. */

import { allocationPicture, highestPower, userLegend } from "./allocation.js";
import { byId, chart, element, fill, row, scroller } from "./dom.js";
import { highestRate, ratesPicture } from "./rates.js";
import { NONE, changedHands, inShort, isUsable, limitRows, saidFor, servedRates, sum } from "./turns.js";
import { clock, human, percent, rate, watts } from "./units.js";
import { aimName, heading, say } from "./words.js";

/** A row of the table for each figure and each limit; those in which the turns differ stand out. */
function figures(turns) {
  const ofDecision = (read) => turns.map(({ decision }) => read(decision));
  const ofAllocation = (read) => turns.map((turn) => (isUsable(turn) ? read(turn.decision, turn) : NONE));
  const first = turns[0].decision;
  const rows = [
    ["console.aim", ofDecision((one) => heading(aimName(one.objective)))],
    ["label.status", ofDecision((one) => say(`status.${one.status}`))],
    ["label.value", ofAllocation((one) => human(one.value, one.unit))],
    ["console.proven", ofDecision((one) => human(one.bound, one.unit))],
    ["label.gap", ofAllocation((one) => (one.gap === null ? NONE : percent(one.gap)))],
    ["label.sum_rate_bps", ofAllocation((one) => rate(sum(one.rate_bps)))],
    ["label.lowest_rate", ofAllocation((_, turn) => rate(Math.min(...servedRates(turn))))],
    ["label.power_w", ofAllocation((one) => watts(one.total_power_w))],
    ["label.users_served", ofAllocation((one) => `${one.rate_bps.filter((bps) => bps > 0).length}/${one.rate_bps.length}`)],
    ["console.subcarriers_moved", ofAllocation((one) => (one === first ? NONE : String(changedHands(first, one).length)))],
  ].map(([key, texts]) => ({ label: heading(say(key)), texts }));
  return [...rows, ...limitRows(turns)].map(({ label, texts }) => {
    const shown = row(label, ...texts);
    shown.classList.toggle("differs", new Set(texts).size > 1);
    return shown;
  });
}

/**
 * Open the comparison of two turns or more.
 * @param {object} session that they are of
 * @param {object[]} turns
 */
export function openComparison(session, turns) {
  const dialog = byId("compare");
  const usable = turns.filter(isUsable);
  const [power, most] = [highestPower(usable.map((turn) => turn.decision)), highestRate(usable) * 1.08];
  const head = element("tr", {}, element("td"), turns.map((turn) => element("th", { scope: "col" },
    `${heading(say("turn.column", { number: turn.number }))} · ${clock(turn.at_utc)}`, element("small", {}, saidFor(session, turn)))));
  const pictures = element("div", { class: "columns" }, usable.map((turn, place) => {
    const moved = place ? changedHands(usable[0].decision, turn.decision) : [];
    return element("section", {}, element("h3", {}, `${turn.number} · ${inShort(turn)}`),
      chart(say("console.allocation"), (width) => allocationPicture([turn.decision], { width, top: power, id: `ca${place}-`, moved })),
      chart(say("console.rates"), (width) => ratesPicture(turn, { width, top: most, id: `cr${place}-` })));
  }));
  fill(byId("compare-body"),
    scroller(say("console.compared"), element("table", { class: "rows figures" },
      element("thead", {}, head), element("tbody", {}, figures(turns)))),
    pictures, usable.length > 0 && userLegend(usable.map((turn) => turn.decision), "c"));
  dialog.showModal();
}
