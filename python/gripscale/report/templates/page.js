"use strict";

const figures = JSON.parse(document.getElementById("figures").textContent);
const chapters = document.querySelectorAll("details");
let drawing = Promise.resolve();

// Draws the figures that stand in no closed chapter, then says on <html data-drawn> how many are.
async function drawOpen() {
  for (const plot of document.querySelectorAll(".plot:empty")) {
    if (!plot.closest("details:not([open])")) {
      const figure = figures[plot.id.replace("plot-", "")];
      const item = {docid: "figure", roots: {[figure.roots[0].id]: plot.id}};
      item.root_ids = Object.keys(item.roots);
      await Bokeh.embed.embed_items({figure}, [item]);
      watchOutlines(Bokeh.documents.at(-1).roots()[0].references());
    }
  }
  rememberWidths();
  document.documentElement.dataset.drawn = document.querySelectorAll(".plot:not(:empty)").length;
}

function drawSoon() {
  drawing = drawing.then(drawOpen);
}

function openChapter(hash) {
  const chapter = document.getElementById(hash.slice(1));
  if (chapter?.matches("details")) {
    chapter.open = true;
  }
}

function openAll(button) {
  const open = [...chapters].every(chapter => chapter.open);
  chapters.forEach(chapter => { chapter.open = !open; });
  button.textContent = open ? "Open all" : "Close all";
}

// Chooses the other colours; `page.css` follows the system until then.
function changeColours() {
  const root = document.documentElement;
  const dark = getComputedStyle(root).getPropertyValue("--figures") !== "none";
  root.className = dark ? "light" : "dark";
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

for (const button of document.querySelectorAll("button")) {
  const work = {"open-all": openAll, "other-colours": changeColours}[button.id] ?? copyText;
  button.hidden = false;
  button.addEventListener("click", () => work(button));
}
document.querySelector("nav").addEventListener("click", event => openChapter(event.target.hash ?? ""));
for (const picture of document.querySelectorAll(".image img")) {
  picture.addEventListener("click", () => picture.classList.toggle("whole"));
}
addEventListener("toggle", drawSoon, true);
addEventListener("resize", rememberWidths);
openChapter(location.hash);
drawSoon();
