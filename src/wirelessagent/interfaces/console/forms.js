/** What all forms have in common: the button waits while they are sent, and what goes wrong stands in them. */

import { element } from "./dom.js";
import { say, trouble } from "./words.js";

/** Show what went wrong in a form's own place for it; null takes it away. */
export function refuse(form, problem) {
  const place = form.querySelector(".problem");
  place.hidden = !problem;
  place.textContent = problem ? trouble(problem) : "";
}

/**
 * Have something done when a form is sent.
 * @param {HTMLFormElement} form
 * @param {(button: HTMLButtonElement|null) => Promise<void>} act gets the button that sent it
 */
export function onSend(form, act) {
  form.onsubmit = async (event) => {
    event.preventDefault();
    refuse(form, null);
    const buttons = form.querySelectorAll("button:not([type=button])");
    const rest = (is) => buttons.forEach((button) => { button.disabled = is; });
    rest(true);
    try {
      await act(event.submitter);
    } catch (problem) {
      refuse(form, problem);
    } finally {
      rest(false);
    }
  };
}

/** The choices of a list, each a value with its text. */
export function choices(list, pairs, chosen = null) {
  list.replaceChildren(...pairs.map(([value, text]) => element("option", { value, selected: value === chosen }, text)));
}

/** Fill each choice of who understands what is said in a new cell: the LLM only where one is set up. */
export function nameRecognisers(llm) {
  for (const list of document.querySelectorAll("select.recogniser")) {
    choices(list, [["offline", say("console.offline")], ...(llm ? [["llm", say("console.llm", { model: llm })]] : [])], list.value);
    list.disabled = !llm;
  }
  for (const note of document.querySelectorAll(".no-llm")) note.hidden = Boolean(llm);
}
