/** Decisions side by side: their figures, their allocations on one scale, their rates on one scale. */

import { allocationPicture, highestPower, userLegend } from "./allocation.js";
import { byId, chart, element, scroller } from "./dom.js";
import { highestRate, ratesPicture } from "./rates.js";
import { changedHands, inShort, isUsable, limitRows, saidFor, sum } from "./turns.js";
import { clock, human, percent, rate, watts } from "./units.js";
import { aimName, heading, say } from "./words.js";

function figures(turns) {
  const rows = [
    [say("console.aim"), ({ decision }) => heading(aimName(decision.objective))],
    [say("label.status"), ({ decision }) => say(`status.${decision.status}`)],
    [say("label.value"), ({ decision }) => human(decision.value, decision.unit), true],
    [say("label.bound"), ({ decision }) => human(decision.bound, decision.unit)],
    [say("label.gap"), ({ decision }) => (Number.isFinite(decision.gap) && decision.gap !== null ? percent(decision.gap) : "–"), true],
    [say("label.sum_rate_bps"), ({ decision }) => rate(sum(decision.rate_bps)), true],
    [say("label.lowest_rate"), ({ decision }) => rate(Math.min(...decision.rate_bps)), true],
    [say("label.power_w"), ({ decision }) => watts(decision.total_power_w), true],
    [say("label.users_served"), ({ decision }) => `${decision.rate_bps.filter((one) => one > 0).length}/${decision.rate_bps.length}`, true],
    [say("console.subcarriers_moved"), (turn) => (turn === turns[0] ? "–" : String(changedHands(turns[0].decision, turn.decision).length)), true],
  ];
  for (const { label, texts } of limitRows(turns)) rows.push([label, (turn) => texts[turns.indexOf(turn)]]);
  return rows.map(([label, read, needsAllocation]) => {
    const cells = turns.map((turn) => (needsAllocation && !isUsable(turn) ? "–" : read(turn)));
    return element("tr", { class: new Set(cells).size > 1 ? "differs" : null },
      element("th", { scope: "row" }, heading(label)), cells.map((text) => element("td", {}, text)));
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
  byId("compare-body").replaceChildren(
    scroller(say("console.compared"), element("table", { class: "rows figures" },
      element("thead", {}, head), element("tbody", {}, figures(turns)))),
    pictures, ...(usable.length ? [userLegend(usable.map((turn) => turn.decision), "c")] : []));
  dialog.showModal();
}
