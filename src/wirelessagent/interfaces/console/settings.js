/** Language and theme; what is chosen stays in this browser. */

import { byId } from "./dom.js";
import { choices } from "./forms.js";

const NAMES = { en: "English", zh: "中文", es: "Español", fr: "Français", de: "Deutsch" };
const LANGUAGE = "wirelessagent.language";
const THEME = "wirelessagent.theme";

/** The language to begin with: the one chosen, else the browser's, else the first. */
export function wantedLanguage(languages) {
  const wishes = [localStorage.getItem(LANGUAGE), ...navigator.languages.map((tag) => tag.slice(0, 2))];
  return wishes.find((wish) => languages.includes(wish)) ?? languages[0];
}

/** Fill the choice of languages; `change` gets what is chosen. */
export function setUpLanguages(languages, current, change) {
  const list = byId("language");
  choices(list, languages.map((tag) => [tag, NAMES[tag] ?? tag]), current);
  list.onchange = () => {
    localStorage.setItem(LANGUAGE, list.value);
    change(list.value);
  };
}

/** The theme button: `changed` draws what holds colours of its own. */
export function setUpTheme(changed) {
  const page = document.documentElement;
  byId("theme").addEventListener("click", () => {
    page.dataset.theme = page.dataset.theme === "dark" ? "light" : "dark";
    localStorage.setItem(THEME, page.dataset.theme);
    changed();
  });
}
