/** A measured channel by drag and drop: what was understood is shown, with its holes, before it becomes a cell. */

import { path, post, put, upload } from "./api.js";
import { gainMatrix } from "./channel.js";
import { byId, element, facts } from "./dom.js";
import { choices, onSend, refuse } from "./forms.js";
import { matrixView } from "./matrix.js";
import { say } from "./words.js";

const UNITS = { "": "console.unit_guess", linear: "console.unit_linear", db: "console.unit_db" };
let understood = null;
let latest = 0;

function usable(is) {
  for (const button of ["upload-make", "upload-use"]) byId(button).disabled = !is;
}

async function read(file, unit) {
  const mine = ++latest;
  understood = null;
  usable(false);
  refuse(byId("upload-form"), null);
  byId("upload-preview").replaceChildren(element("div", { class: "skeleton tall" }));
  try {
    const query = new URLSearchParams({ name: file.name, ...(unit ? { unit } : {}) });
    const found = await upload(`v1/observations?${query}`, file);
    if (mine === latest) preview(found);
  } catch (problem) {
    if (mine !== latest) return;
    byId("upload-preview").replaceChildren();
    refuse(byId("upload-form"), problem);
  }
}

function preview(found) {
  understood = found;
  const total = found.num_users * found.num_subcarriers;
  const place = element("div");
  byId("upload-preview").replaceChildren(
    facts(Object.entries(found.facts)),
    element("p", { class: found.missing ? "note warn" : "note" }, say("console.upload_missing", { missing: found.missing, total })),
    place);
  matrixView(place).show(gainMatrix(found.gain, found.user_names));
  usable(true);
}

function open(file, cell) {
  byId("upload-use").hidden = !cell;
  byId("upload-use").textContent = say("console.use_here", { name: cell?.name });
  byId("upload-name").value = file.name.replace(/\.[^.]*$/, "");
  byId("upload-unit").value = "";
  byId("upload-unit").onchange = (event) => read(file, event.target.value);
  if (!byId("upload").open) byId("upload").showModal();
  read(file, "");
}

/**
 * Take files that are dropped anywhere or chosen.
 * @param {{made: (cell: object) => void, cell: () => object|null, allowed: () => boolean}} actions `cell` is looked at
 */
export function setUpUpload({ made, cell, allowed }) {
  const carries = (event) => allowed() && [...(event.dataTransfer?.types ?? [])].includes("Files");
  const mark = (on) => document.body.classList.toggle("dropping", on);
  document.addEventListener("dragover", (event) => {
    if (!carries(event)) return;
    event.preventDefault();
    mark(true);
  });
  document.addEventListener("dragleave", (event) => event.relatedTarget || mark(false));
  document.addEventListener("drop", (event) => {
    mark(false);
    if (!carries(event)) return;
    event.preventDefault();
    open(event.dataTransfer.files[0], cell());
  });
  byId("upload-file").addEventListener("change", (event) => {
    if (event.target.files[0]) open(event.target.files[0], cell());
    event.target.value = "";
  });
  const newCell = () => {
    const budget = Number(byId("upload-power").value);
    const options = { csi: understood.id, recogniser: byId("upload-recogniser").value, ...(budget > 0 ? { cell_max_power_w: budget } : {}) };
    return post("v1/cells", { name: byId("upload-name").value, options });
  };
  onSend(byId("upload-form"), async (button) => {
    const moved = () => put(path`v1/cells/${cell().id}/observation`, { observation: understood.id });
    made(await (button === byId("upload-use") ? moved() : newCell()));
    byId("upload").close();
  });
}

/** Fill the choice of units in the language in use. */
export function nameUnits() {
  choices(byId("upload-unit"), Object.entries(UNITS).map(([unit, key]) => [unit, say(key)]));
}
