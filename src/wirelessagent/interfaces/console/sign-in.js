/** The sign-in page: a token for a cookie. */

import { post } from "./api.js";
import { byId } from "./dom.js";
import { onSend } from "./forms.js";
import { wantedLanguage } from "./settings.js";
import { say, speak } from "./words.js";

await speak(wantedLanguage(["en", "zh", "es", "fr", "de"]));
document.title = `${say("console.sign_in")} · WirelessAgent`;

onSend(byId("sign-in"), async () => {
  byId("token").select();
  await post("sign-in", { token: byId("token").value.trim() });
  location.href = "./";
});
