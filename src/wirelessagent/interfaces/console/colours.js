/** Colours that colour-blind people tell apart: users by hue and pattern, gains in cividis. */

import { shape } from "./dom.js";

const HUES = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#8c6bb1", "#7a7a7a"];
const CIVIDIS = [[0, 34, 78], [67, 78, 108], [125, 124, 120], [188, 175, 111], [254, 232, 56]];
const STROKES = ["", "M0 6L6 0", "M0 0L6 6", "M0 3H6", "M3 0V6", "M0 3H6M3 0V6", "M0 0L6 6M0 6L6 0", "M2 3H4"];

/** The colour of a user by its place. */
const hue = (user) => HUES[user % HUES.length];

/**
 * What fills the shapes of a user: its hue, and a pattern on it from the ninth user on.
 * @param {number} user index from 0; below 0 is nobody
 * @param {string} prefix of the patterns of this picture, as given to {@link patterns}
 */
export function fillOf(user, prefix) {
  if (user < 0) return "var(--hole)";
  return user < HUES.length ? hue(user) : `url(#${prefix}${user % (HUES.length * STROKES.length)})`;
}

/** The patterns that a picture of so many users needs. */
export function patterns(users, prefix) {
  const made = [];
  for (let user = HUES.length; user < Math.min(users, HUES.length * STROKES.length); user += 1) {
    made.push(shape("pattern", { id: prefix + user, width: 6, height: 6, patternUnits: "userSpaceOnUse" },
      shape("rect", { width: 6, height: 6, fill: hue(user) }),
      shape("path", { d: STROKES[Math.floor(user / HUES.length)], stroke: "#fff", "stroke-width": 1.4 })));
  }
  return shape("defs", {}, made);
}

/** The cividis colour of a share between 0 and 1. */
export function cividis(share) {
  const place = Math.max(0, Math.min(1, share)) * (CIVIDIS.length - 1);
  const below = Math.min(CIVIDIS.length - 2, Math.floor(place));
  const part = CIVIDIS[below].map((value, channel) => value + (CIVIDIS[below + 1][channel] - value) * (place - below));
  return `rgb(${part.map(Math.round).join(" ")})`;
}
