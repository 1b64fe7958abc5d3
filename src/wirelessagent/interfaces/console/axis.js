/** A vertical axis with few round marks. */

import { shape } from "./dom.js";
import { digits } from "./units.js";

/** Round marks from 0 up to `top`, at most four. */
export function marks(top) {
  if (!(top > 0)) return [];
  const rough = top / 4;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((factor) => factor * power).find((size) => size >= rough);
  const count = Math.floor(top / step + 1e-9);
  return Array.from({ length: count }, (_, place) => (place + 1) * step);
}

/**
 * Lines with their figures, for bars that stand on `base` and reach `height` at `top`.
 * @param {{left: number, right: number, base: number, height: number, top: number}} room
 */
export function axis({ left, right, base, height, top }) {
  return shape("g", { class: "axis" },
    shape("line", { x1: left, x2: right, y1: base, y2: base }),
    marks(top).map((value) => {
      const y = base - (value / top) * height;
      return [shape("line", { x1: left, x2: right, y1: y, y2: y }),
        shape("text", { x: left - 6, y: y + 4, "text-anchor": "end" }, digits(value))];
    }).flat());
}
