/** Tabs over one picture: arrow keys move, as the ARIA pattern has it. */

import { byId, element } from "./dom.js";

/**
 * @param {HTMLElement} root an empty element that becomes the tab list
 * @param {Array<[string, string]>} choices names with their texts
 * @param {string} chosen
 * @param {string} controls id of the panel
 * @param {(name: string) => void} choose
 */
export function tabs(root, choices, chosen, controls, choose) {
  root.setAttribute("role", "tablist");
  const buttons = choices.map(([name, text]) => element("button", {
    type: "button", role: "tab", id: `${controls}-${name}`, "aria-controls": controls,
    "aria-selected": String(name === chosen), tabindex: name === chosen ? "0" : "-1",
    click: () => pick(name),
  }, text));
  function pick(name) {
    tabs(root, choices, name, controls, choose);
    root.querySelector("[aria-selected=true]").focus();
    choose(name);
  }
  const step = { ArrowRight: 1, ArrowLeft: -1 };
  root.onkeydown = (event) => {
    if (!(event.key in step)) return;
    const at = choices.findIndex(([name]) => name === chosen);
    pick(choices[(at + step[event.key] + choices.length) % choices.length][0]);
  };
  root.replaceChildren(...buttons);
  byId(controls).setAttribute("aria-labelledby", `${controls}-${chosen}`);
}
