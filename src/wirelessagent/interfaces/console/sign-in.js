/** The sign-in page: a token for a cookie. */

import { post } from "./api.js";
import { byId } from "./dom.js";
import { wantedLanguage } from "./settings.js";
import { say, speak, trouble } from "./words.js";

const LANGUAGES = ["en", "zh", "es", "fr", "de"];

await speak(wantedLanguage(LANGUAGES));
document.title = `${say("console.sign_in")} · WirelessAgent`;

byId("sign-in").addEventListener("submit", async (event) => {
  event.preventDefault();
  const refused = byId("refused");
  refused.hidden = true;
  try {
    await post("sign-in", { token: byId("token").value.trim() });
    location.href = "./";
  } catch (problem) {
    refused.textContent = trouble(problem);
    refused.hidden = false;
    byId("token").select();
  }
});
