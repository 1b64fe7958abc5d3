/** What the console says: the catalogue of one language, fetched once, and what users, aims and stages are called. */

import { Disconnected, get, path } from "./api.js";

let texts = {};
let spoken = "en";

/** The language in use. */
export const language = () => spoken;

/** Fetch a language and set every text of the page that stands in the markup. */
export async function speak(wanted) {
  texts = await get(path`v1/words/${wanted}`);
  spoken = wanted;
  document.documentElement.lang = wanted;
  for (const node of document.querySelectorAll("[data-say]")) node.textContent = say(node.dataset.say);
  for (const node of document.querySelectorAll("[data-say-label]")) node.setAttribute("aria-label", say(node.dataset.sayLabel));
}

/**
 * A text by its key, with its {places} filled.
 * @param {string} key such as "console.apply"
 * @param {Object<string, unknown>} [places]
 */
export function say(key, places = {}) {
  const text = texts[key] ?? key;
  return text.replace(/\{(\w+)(?::[^}]*)?\}/g, (whole, name) => (name in places ? String(places[name]) : whole));
}

/** Whether there is a text of this key. */
export const has = (key) => key in texts;

/** What went wrong, in words. */
export const trouble = (problem) => (problem instanceof Disconnected && has("console.disconnected") ? say("console.disconnected") : problem.message);

/** What a user is called here: "user 3" in the language in use, a name of its own as it is. */
export function userName(name) {
  const numbered = /^user\s*(\d+)$/i.exec(name);
  return numbered ? say("whom.user", { number: numbered[1] }) : name;
}

/** What an objective is called; one of a plug-in by its own name. */
export const aimName = (objective) => (has(`goal.${objective}`) ? say(`goal.${objective}`) : objective.replaceAll("_", " "));

/** What a turn came to, in a word. */
export const stageName = (stage) => (has(`came_to.${stage}`) ? say(`came_to.${stage}`) : stage);

/** A text with its first letter large, as a heading wants it. */
export const heading = (text) => text.charAt(0).toLocaleUpperCase(spoken) + text.slice(1);
