// Draws the charts of the scenes in ODE. Data: the JSON in #data; colours: the page's style sheet.
// Leaves on <html>: data-charts (how many were drawn), data-points (how many points they hold), data-error (a failure).
'use strict';
(() => {
  const root = document.documentElement;
  window.addEventListener('error', (event) => { root.dataset.error = event.message; });
  const colour = (name) => getComputedStyle(root).getPropertyValue('--' + name).trim();
  const names = ['blue', 'orange', 'red', 'green', 'purple', 'sky', 'grey'];
  const dashes = [[], [6, 3], [2, 3], [9, 3, 2, 3]];
  const axis = (title, type) => ({
    type, title: {display: true, text: title, color: colour('quiet')}, grid: {color: colour('grid'), drawBorder: false},
    ticks: {color: colour('quiet'), maxRotation: 0, maxTicksLimit: 9}
  });
  let charts = 0;
  let points = 0;
  for (const chart of JSON.parse(document.getElementById('data').textContent)) {
    const canvas = document.getElementById(chart.id);
    if (!canvas) continue;
    new Chart(canvas, {
      type: 'line',
      data: {
        datasets: chart.series.map((series, i) => ({
          label: series.name, data: series.points.map(([x, y]) => ({x, y})), borderColor: colour(names[i % names.length]),
          backgroundColor: colour(names[i % names.length]), borderDash: dashes[Math.floor(i / names.length) % dashes.length],
          borderWidth: 1.6, pointRadius: 0, pointHitRadius: 6
        }))
      },
      options: {
        animation: false, maintainAspectRatio: false, parsing: false, normalized: true,
        scales: {x: axis(chart.x, 'linear'), y: axis(chart.y, chart.logarithmic ? 'logarithmic' : 'linear')},
        plugins: {legend: {position: 'bottom', labels: {color: colour('ink'), boxWidth: 22, font: {size: 11}}}}
      }
    });
    charts += 1;
    points += chart.series.reduce((sum, series) => sum + series.points.length, 0);
  }
  root.dataset.charts = charts;
  root.dataset.points = points;
})();
