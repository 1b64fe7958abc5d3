/** The cell that is looked at: picked from the list, with its facts; a new one simulated; one removed. */

import { post } from "./api.js";
import { button, byId, element, facts, fill } from "./dom.js";
import { onSend } from "./forms.js";
import { watts } from "./units.js";
import { say } from "./words.js";

/** A cell in one line. */
const cellLine = (cell) => say("console.cell_line", { users: cell.user_names.length, subcarriers: cell.num_subcarriers });

/** Draw the picker. */
export function drawCells(cells, cell, canAct, actions) {
  byId("cell-name").textContent = cell.name;
  byId("cell-size").textContent = cellLine(cell);
  fill(byId("cell-list"), cells.map((one) => element("li", {},
    button(() => actions.pick(one.id), { "aria-current": one.id === cell.id && "true" },
      element("b", {}, one.name), element("span", {}, cellLine(one))))));
  fill(byId("cell-facts"), facts([...Object.entries(cell.facts),
    [say("console.base_station"), cell.base_station ?? "–"], [say("console.budget"), watts(cell.max_power_w)],
    [say("console.recogniser"), cell.recogniser === "llm" ? "LLM" : say("console.offline")]]));
  byId("cell-remove").hidden = !canAct || cell.demonstration || cells.length < 2;
}

/** The form for a simulated cell. */
export function setUpNewCell(made) {
  const number = (id) => Number(byId(id).value);
  onSend(byId("cell-form"), async () => made(await post("v1/cells", {
    name: byId("new-name").value,
    options: {
      seed: number("new-seed"), cell_max_power_w: number("new-power"), recogniser: byId("new-recogniser").value,
      source_options: { num_users: number("new-users"), num_subcarriers: number("new-subcarriers") },
      loss: number("new-lost") > 0 ? [`random:${number("new-lost") / 100}`] : [],
    },
  })));
}
