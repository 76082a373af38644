// Draws the charts of a study of accuracy, with parts.js.
(() => {
  const {data, charts, colour, trim, micro, decade, axis} = page;
  const names = ['blue', 'orange', 'red', 'green', 'purple', 'sky', 'grey'];
  const dashes = [[], [6, 3], [2, 3], [9, 3, 2, 3], [4, 4], [1, 2], [8, 2]];
  const signs = ['circle', 'rect', 'triangle', 'rectRot', 'star', 'crossRot', 'cross'];

  const limit = (kind) => (value) => kind === 'us' ? micro(value) : trim(value, 6);
  const percent = (value) => trim(value) + ' %';

  /** Vertical bars from point.low to point.high. */
  const whiskers = {
    id: 'whiskers',
    beforeDatasetsDraw(chart) {
      const {ctx, chartArea: area, scales: {y}} = chart;
      chart.data.datasets.forEach((dataset, index) => {
        if (!chart.isDatasetVisible(index)) return;
        ctx.save();
        ctx.beginPath();
        ctx.rect(area.left, area.top, area.width, area.height);
        ctx.clip();
        ctx.strokeStyle = dataset.borderColor;
        ctx.globalAlpha = 0.55;
        chart.getDatasetMeta(index).data.forEach((element, i) => {
          const point = dataset.data[i];
          if (point.low == null) return;
          ctx.beginPath();
          ctx.moveTo(element.x, y.getPixelForValue(Math.max(point.low, y.min)));
          ctx.lineTo(element.x, y.getPixelForValue(point.high));
          ctx.stroke();
        });
        ctx.restore();
      });
    }
  };

  const line = (label, i, points, more = {}) => ({
    label, data: points, borderColor: colour(names[i % names.length]), backgroundColor: colour(names[i % names.length]),
    borderDash: dashes[i % dashes.length], pointStyle: signs[i % signs.length], borderWidth: 1.8, pointRadius: 4,
    pointHitRadius: 8, clip: 8, ...more
  });

  function draw(id, datasets, scales, tooltip) {
    const canvas = document.getElementById(id);
    if (!canvas) return;
    charts.push(new Chart(canvas, {
      type: 'line', data: {datasets}, plugins: [whiskers],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, parsing: false, scales,
        interaction: {mode: 'nearest', intersect: false},
        plugins: {
          legend: {labels: {color: colour('ink'), usePointStyle: true, boxHeight: 7}}, tooltip: {callbacks: tooltip}
        }
      }
    }));
  }

  // Where lines end and begin, so that a limit's axis has its own values as marks.
  const limitAxis = (kind, amounts) => axis(kind === 'us' ? 'limit of a query' : 'work units of a query', {
    type: 'logarithmic', min: amounts[0], max: amounts[amounts.length - 1],
    afterBuildTicks: (scale) => { scale.ticks = amounts.map((value) => ({value})); },
    ticks: {callback: limit(kind), autoSkip: true}
  });

  const of = (kind, scope) => data.series.filter((s) => s.kind === kind && s.scope === scope);
  const thresholds = (kind) => [...new Set(of(kind, 'all').map((s) => s.pMin))];
  const mainOf = (kind, scope) => of(kind, scope).filter((s) => s.pMin === thresholds(kind)[0]);
  const amountsOf = (kind) => mainOf(kind, 'all').flatMap((s) => s.points.map((p) => p.x));
  const mainKind = () => of('us', 'all').length ? 'us' : 'work';
  const bounds = (p) => percent(p.share == null ? p.y : p.share) + ' (' + percent(p.low) + ' to ' + percent(p.high) + ', of ' + p.n + ')';
  const withBounds = (kind) => ({
    title: (items) => items.length ? limit(kind)(items[0].parsed.x) : '',
    label: (item) => item.dataset.label + ': ' + bounds(item.raw)
  });

  // Small shares matter, so the axis is logarithmic; none at all stands on its lower end.
  const floor = 0.01;
  const logPercent = (title) => axis(title, {type: 'logarithmic', min: floor, max: 100, ticks: {
    callback: (value) => decade(value) ? (value === floor ? 'none' : trim(value)) : ''}});
  const logPoint = (p) => ({...p, y: Math.max(p.y, floor), share: p.y});

  function drawShares(kind) {
    if (!of(kind, 'all').length) return;
    const groups = [...mainOf(kind, 'group'), ...mainOf(kind, 'all')];
    const lines = (key, least) => groups.map((s, i) => line(s.band, s.band === 'all' ? 6 : i,
      s.points.map((p) => ({...p[key], y: Math.max(p[key].y, least), share: p[key].y})),
      s.band === 'all' ? {borderColor: colour('ink'), backgroundColor: colour('ink'), borderDash: [2, 2], pointRadius: 2} : {}));
    draw('error-' + kind, lines('wrong', floor), {
      x: limitAxis(kind, amountsOf(kind)), y: logPercent('wrong verdicts, %')
    }, withBounds(kind));
    draw('proved-' + kind, lines('proved', 0), {
      x: limitAxis(kind, amountsOf(kind)), y: axis('proved, %', {min: 0, max: 100})
    }, withBounds(kind));
  }

  function drawThresholds() {
    const kind = mainKind();
    const sets = of(kind, 'all');
    const name = (s) => s.pMin < 1 ? 'p ≥ ' + s.pMin : 'never on probability';
    draw('error-p', sets.map((s, i) => line(name(s), i, s.points.map((p) => logPoint(p.wrong)))), {
      x: limitAxis(kind, amountsOf(kind)), y: logPercent('wrong verdicts, %')
    }, withBounds(kind));
    draw('time-p', sets.map((s, i) => line(name(s), i, s.points.map((p) => ({x: p.x, y: p.wall[0]})))), {
      x: limitAxis(kind, amountsOf(kind)), y: axis('median time, µs', {type: 'logarithmic'})
    }, {label: (item) => item.dataset.label + ': ' + micro(item.parsed.y)});
  }

  function drawReliability() {
    const kind = mainKind();
    const points = mainOf(kind, 'all').flatMap((s) => s.points).filter((p) => p.unproved > 0).slice(0, 5);
    const sets = points.map((p, i) => line(
      limit(kind)(p.x) + ', error ' + trim(p.ece, 2), i, p.reliability.filter((bin) => bin.n >= 10).map((bin) => ({...bin, x: 100 * bin.x}))))
      .filter((set) => set.data.length);
    sets.push({label: 'as stated', data: [{x: 0, y: 0}, {x: 100, y: 100}], borderColor: colour('grey'),
      borderDash: [6, 4], borderWidth: 1, pointRadius: 0, pointStyle: 'line'});
    draw('reliability', sets, {
      x: axis('stated probability of a hit, %', {type: 'linear', min: 0, max: 100}),
      y: axis('were hits, %', {min: 0, max: 100})
    }, {
      title: (items) => items.length ? 'stated ' + percent(items[0].parsed.x) : '',
      label: (item) => item.raw.low == null ? '' : item.dataset.label + ': ' + bounds(item.raw)
    });
  }

  function drawKinds() {
    const kind = mainKind();
    const points = mainOf(kind, 'all').flatMap((s) => s.points);
    draw('kinds', [line('false hits', 1, points.map((p) => logPoint(p.falseHits))),
      line('false misses', 0, points.map((p) => logPoint(p.falseMisses)))], {
      x: limitAxis(kind, amountsOf(kind)), y: logPercent('of the poses that could be wrong so, %')
    }, withBounds(kind));
  }

  function drawTail() {
    const kind = mainKind();
    const points = mainOf(kind, 'all').flatMap((s) => s.points);
    const sets = ['50 %', '99 %', '99.9 %', 'longest'].map((label, i) =>
      line(label, i, points.map((p) => ({x: p.x, y: p.wall[i]}))));
    const ends = [points[0].x, points[points.length - 1].x];
    const flat = (label, us, dash) => ({label, data: ends.map((x) => ({x, y: us})), borderColor: colour('ink'),
      borderWidth: 1, borderDash: dash, pointRadius: 0, pointStyle: 'line'});
    sets.push(flat('exact, 50 %', data.exact.all[0], []), flat('exact, 99 %', data.exact.all[1], [6, 3]));
    if (kind === 'us') {
      sets.push({label: 'the limit', data: ends.map((x) => ({x, y: x})), borderColor: colour('grey'), borderWidth: 1,
        borderDash: [4, 4], pointRadius: 0, pointStyle: 'line'});
    }
    draw('tail', sets, {
      x: limitAxis(kind, amountsOf(kind)), y: axis('time of a query', {type: 'logarithmic', ticks: {
        callback: (value) => decade(value) ? micro(value) : ''}})
    }, {label: (item) => item.dataset.label + ': ' + micro(item.parsed.y)});
  }

  function drawContacts() {
    const kind = mainKind();
    const lines = (key) => mainOf(kind, 'group').map((s, i) => line(s.band, i,
      s.points.filter((p) => p.contact).map((p) => ({x: p.x, y: p.contact[key], n: p.contact.n}))))
      .filter((set) => set.data.length);
    const of = (unit) => ({label: (item) => item.dataset.label + ': ' + trim(item.parsed.y) + ' ' + unit + ', of ' + item.raw.n});
    draw('position', lines('position'), {
      x: limitAxis(kind, amountsOf(kind)), y: axis('median error of the place, % of the size', {min: 0})
    }, of('%'));
    draw('normal', lines('normal'), {
      x: limitAxis(kind, amountsOf(kind)), y: axis('median error of the normal, degrees', {min: 0})
    }, of('°'));
  }

  page.show(() => {
    drawShares('us');
    drawShares('work');
    drawThresholds();
    drawReliability();
    drawKinds();
    drawTail();
    drawContacts();
  });
})();
