/** The channel of a cell: what was sensed with its holes, what was repaired, and how sure each gain is. */

import { byId, nothing } from "./dom.js";
import { matrixView } from "./matrix.js";
import { tabs } from "./tabs.js";
import { decibel, digits, level } from "./units.js";
import { say, userName } from "./words.js";

let chosen = "sensed";
let view = null;

/** Lowest and highest finite value of a matrix. */
function rangeOf(values) {
  const known = values.flat().filter(Number.isFinite).sort((one, other) => one - other);
  return [known[0] ?? 0, known.at(-1) ?? 0];
}

function coloured([low, high]) {
  return { range: [low, high], scale: say("console.range", { low: level(low), high: `${level(high)} dB` }) };
}

/**
 * Gains as a matrix to be shown, in dB.
 * @param {Array<Array<number|null>>} gains linear, null where missing
 * @param {string[]} userNames
 */
export function gainMatrix(gains, userNames, repaired = null) {
  const values = gains.map((row) => row.map((gain) => (gain === null ? null : decibel(gain))));
  const read = (value, row, column) => say("console.reading", {
    who: userName(userNames[row]), place: column + 1,
    value: value === null ? say("console.not_reported") : `${level(value)} dB`,
  }) + (repaired?.[row][column] ? ` (${say("console.was_repaired")})` : "");
  return { names: userNames.map(userName), values, read, label: say("console.channel"), ...coloured(rangeOf(values)) };
}

function sureMatrix({ gain, gain_sd: deviation, user_names: names }) {
  const values = gain.map((row, user) => row.map((one, place) => (one > 0 ? decibel(1 + deviation[user][place] / one) : 0)));
  const read = (value, row, column) => say("console.reading", {
    who: userName(names[row]), place: column + 1, value: `± ${digits(value, 2)} dB`,
  });
  const [, high] = rangeOf(values);
  const scale = say("console.range", { low: "± 0", high: `± ${digits(high, 2)} dB` });
  return { names: names.map(userName), values, read, label: say("console.how_sure"), range: [0, high], scale };
}

/** Draw the channel of what is looked at; null before anything was sensed. */
export function drawChannel(channel) {
  const place = byId("channel-picture");
  byId("channel-tabs").hidden = !channel;
  byId("channel-note").textContent = channel ? say(chosen === "sure" ? "console.channel_note_sure" : "console.channel_note") : "";
  if (!channel) {
    view = null;
    return place.replaceChildren(nothing(say("console.no_channel")));
  }
  const choices = [["sensed", say("console.sensed")], ["repaired", say("console.repaired")], ["sure", say("console.how_sure")]];
  tabs(byId("channel-tabs"), choices, chosen, "channel-picture", (name) => {
    chosen = name;
    drawChannel(channel);
  });
  const full = gainMatrix(channel.gain, channel.user_names, channel.repaired);
  const shown = {
    sensed: () => ({ ...gainMatrix(channel.observed_gain, channel.user_names), ...coloured(full.range) }),
    repaired: () => full,
    sure: () => sureMatrix(channel),
  }[chosen]();
  view ??= matrixView(place);
  view.show(shown);
}
