/** What leaves the console: files of one allocation, the standards' documents, a printed report. */

import { address, post } from "./api.js";
import { button, byId, element, fill } from "./dom.js";
import { language, say } from "./words.js";

const FILES = ["csv", "json", "npz", "png", "svg"];
const DOCUMENTS = [["ts28312", "TS 28.312"], ["tmf921", "TMF921"]];

function save(name, text) {
  const link = element("a", { href: URL.createObjectURL(new Blob([text], { type: "application/json" })), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

async function standard(number, format, failed) {
  try {
    const { record } = await post("v1/operations/export", { number, format });
    save(`${format}-${number}.json`, JSON.stringify(record, null, 2));
  } catch (problem) {
    failed(problem);
  }
}

/** Draw the menu for the turn that is looked at; files are of turns that are in the history, as a recorded one is not. */
export function drawExport(turn, failed) {
  const stored = turn?.stored ?? null;
  const title = stored === null ? say("console.export_none") : say("turn.column", { number: turn.number });
  const files = FILES.map((format) =>
    element("a", { href: address(`v1/allocations/${stored}?format=${format}`), download: `allocation-${stored}.${format}` }, format.toUpperCase()));
  const documents = DOCUMENTS.map(([format, name]) => button(() => standard(stored, format, failed), {}, name));
  const offered = [...(stored === null ? [] : [...files, ...documents]), button(() => window.print(), {}, say("console.print"))];
  fill(byId("export-list"), element("li", { class: "note" }, title), offered.map((one) => element("li", {}, one)));
}

/** A report, however it is printed: when that was, and each user's figures beside the picture. */
export function setUpReport() {
  window.addEventListener("beforeprint", () => {
    byId("printed").textContent = new Date().toLocaleString(language(), { dateStyle: "long", timeStyle: "short" });
    for (const details of document.querySelectorAll("details.as-table")) details.open = true;
  });
}
