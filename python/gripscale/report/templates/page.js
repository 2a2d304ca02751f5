"use strict";

// Draws the figures from the data block of the page, then says so on <html data-drawn>.
async function drawAll() {
  const {places, document: figures} = JSON.parse(document.getElementById("figures").textContent);
  const item = {docid: "figures", roots: places, root_ids: Object.keys(places)};
  await Bokeh.embed.embed_items({figures}, [item]);
  const roots = Bokeh.documents.flatMap(each => each.roots());
  watchOutlines(new Set(roots.flatMap(root => [...root.references()])));
  document.documentElement.dataset.drawn = String(roots.length);
}

// Remembers the width of each figure for the print stylesheet.
function rememberWidths() {
  if (matchMedia("print").matches) {
    return;
  }
  for (const plot of document.querySelectorAll(".plot")) {
    plot.style.removeProperty("--drawn-width");
    plot.style.setProperty("--drawn-width", `${plot.clientWidth}px`);
  }
}

async function copyText(button) {
  const text = document.getElementById(button.dataset.copies).textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    const range = document.createRange();
    range.selectNodeContents(document.getElementById(button.dataset.copies));
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    button.textContent = "Selected: press Ctrl+C";
  }
}

for (const button of document.querySelectorAll("button[data-copies]")) {
  button.hidden = false;
  button.addEventListener("click", () => copyText(button));
}
addEventListener("resize", rememberWidths);
rememberWidths();
drawAll();
