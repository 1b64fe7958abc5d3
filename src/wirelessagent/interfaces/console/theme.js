"use strict";
// Runs before the page is drawn, so that a chosen theme does not flash: everything else is a module and comes later.
{
  const chosen = localStorage.getItem("wirelessagent.theme");
  const dark = chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";
}
