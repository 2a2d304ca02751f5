"use strict";

// Draws outlines of many points with what their frame shows: a line from the lowest to the highest
// value in each column of pixels, or every piece where there are fewer pieces than columns.
// The source of an outline has the tags "outline", the source of all its pieces, and the names of
// the columns there: abscissa, lowest and highest value (gripscale/charts/page.py).

function firstAtLeast(sorted, value) {
  let low = 0;
  let high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] < value) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

function piecesSeen(x, low, high, start, end, columns) {
  const first = Math.max(firstAtLeast(x, start) - 1, 0);
  const last = Math.min(firstAtLeast(x, end) + 1, x.length);
  // columns are multiples of their width, so that a pan does not change what they hold
  const width = last - first > columns ? (end - start) / columns : 0;
  const most = 2 * (Math.min(columns, last - first) + 4);
  const seen = {x: new Float64Array(most), y: new Float64Array(most)};
  let size = 0;
  for (let i = first; i < last; size += 2) {
    const end = (Math.floor(x[i] / width) + 1) * width; // NaN where every piece is drawn
    let [begin, least, largest] = [i, low[i], high[i]];
    for (i += 1; i < last && x[i] < end; i += 1) {
      if (low[i] < least || Number.isNaN(least)) {
        least = low[i];
      }
      if (high[i] > largest || Number.isNaN(largest)) {
        largest = high[i];
      }
    }
    seen.x.set([x[begin], x[i - 1]], size);
    seen.y.set([least, largest], size);
  }
  return {x: seen.x.subarray(0, size), y: seen.y.subarray(0, size)};
}

function drawOutlines(plot) {
  const {start, end} = plot.x_range;
  for (const {data_source: source} of plot.renderers) {
    const [kind, pieces, ...names] = source?.tags ?? [];
    if (kind === "outline") {
      const columns = names.map(name => pieces.data[name]);
      source.data = piecesSeen(...columns, start, end, Math.max(plot.inner_width, 300));
    }
  }
}

// Follows the abscissa of every figure among models.
function watchOutlines(models) {
  for (const plot of models) {
    if (plot.x_range && plot.renderers) {
      drawOutlines(plot);
      plot.x_range.change.connect(() => drawOutlines(plot));
    }
  }
}
