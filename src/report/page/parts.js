// What the charts of all report pages share. It stands before a page's own script, in the same element.
// Data: the JSON in #data; colours: the page's style sheet.
// Leaves on <html>: data-charts (how many were drawn), data-points (how many points they hold), data-error (a failure).
'use strict';
const page = (() => {
  const root = document.documentElement;
  window.addEventListener('error', (event) => { root.dataset.error = event.message; });
  const data = JSON.parse(document.getElementById('data').textContent);
  const charts = [];
  const colour = (name) => getComputedStyle(root).getPropertyValue('--' + name).trim();

  // Text -----------------------------------------------------------------------------------------------------------
  const trim = (value, digits = 3) => String(Number(value.toPrecision(digits)));
  const micro = (us, digits = 3) => us == null ? '–' : us >= 1e6 ? trim(us / 1e6, digits) + ' s'
    : us >= 1e3 ? trim(us / 1e3, digits) + ' ms' : us >= 1 || us === 0 ? trim(us, digits) + ' µs' : trim(us * 1e3, digits) + ' ns';
  const decade = (value) => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;

  // Building blocks ------------------------------------------------------------------------------------------------
  const axis = (title, more = {}) => ({
    title: {display: true, text: title, color: colour('quiet')}, grid: {color: colour('grid'), drawBorder: false}, ...more,
    ticks: {color: colour('quiet'), maxRotation: 0, ...(more.ticks || {})}
  });

  /** Draws now, and again when the colours change. */
  function show(drawCharts) {
    const draw = () => {
      charts.splice(0).forEach((chart) => chart.destroy());
      drawCharts();
      root.dataset.points = charts.reduce((sum, chart) =>
        sum + chart.data.datasets.reduce((inner, dataset) => inner + dataset.data.length, 0), 0);
      root.dataset.charts = charts.length;
    };
    draw();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  }

  return {data, charts, colour, trim, micro, decade, axis, show};
})();
