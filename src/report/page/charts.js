// Draws the charts of a run report, with parts.js.
(() => {
  const {data, charts, colour, trim, micro, decade, axis} = page;
  const time = data.time;
  const percentile = (x) => x <= 1 ? '0 %' : String(Number((100 - 100 / x).toFixed(Math.max(0, Math.ceil(Math.log10(x)) - 2)))) + ' %';

  // Plug-ins ---------------------------------------------------------------------------------------------------------
  /** Dashed lines at limits: [{at, label, axis}]. */
  const limits = {
    id: 'limits',
    afterDatasetsDraw(chart, _, lines) {
      const {ctx, chartArea: area, scales} = chart;
      for (const line of lines.lines || []) {
        const vertical = line.axis === 'x';
        const at = scales[vertical ? 'x' : 'y'].getPixelForValue(line.at);
        if (!(vertical ? at >= area.left && at <= area.right : at >= area.top && at <= area.bottom)) continue;
        ctx.save();
        ctx.strokeStyle = ctx.fillStyle = colour('red');
        ctx.setLineDash([6, 4]);
        ctx.beginPath();
        if (vertical) { ctx.moveTo(at, area.top); ctx.lineTo(at, area.bottom); }
        else { ctx.moveTo(area.left, at); ctx.lineTo(area.right, at); }
        ctx.stroke();
        ctx.font = '11px system-ui, sans-serif';
        if (vertical) {
          const beyond = at + 4 + ctx.measureText(line.label).width > area.right;  // no room on the right of the line
          ctx.textAlign = beyond ? 'right' : 'left';
          ctx.fillText(line.label, at + (beyond ? -4 : 4), area.top + (beyond ? 24 : 11));
        }
        else { ctx.textAlign = 'right'; ctx.fillText(line.label, area.right - 4, at - 4); }
        ctx.restore();
      }
    }
  };

  /** Time lines share one window (drag to choose, double-click for all) and one cursor. */
  const shared = {cursor: null, from: null, to: null};
  const timeCharts = () => charts.filter((chart) => chart.canvas.closest('.timeline'));
  const timeWindow = {
    id: 'timeWindow',
    afterInit(chart) {
      const canvas = chart.canvas;
      if (!canvas.closest('.timeline')) return;
      const value = (event) => chart.scales.x.getValueForPixel(event.offsetX);
      const redraw = () => timeCharts().forEach((other) => other.draw());
      const show = (min, max) => timeCharts().forEach((other) => {
        Object.assign(other.options.scales.x, {min, max});
        other.update('none');
      });
      canvas.onpointerdown = (event) => { shared.from = shared.to = value(event); };
      canvas.onpointermove = (event) => {
        shared.cursor = value(event);
        if (shared.from !== null) shared.to = shared.cursor;
        redraw();
      };
      canvas.onpointerup = () => {
        const [from, to] = [shared.from, shared.to];
        shared.from = shared.to = null;
        const width = Math.abs(chart.scales.x.getPixelForValue(to) - chart.scales.x.getPixelForValue(from));
        if (width > 8) show(Math.min(from, to), Math.max(from, to)); else redraw();
      };
      canvas.onpointerleave = () => { shared.cursor = shared.from = shared.to = null; redraw(); };
      canvas.ondblclick = () => show(0, data.end_s);
    },
    afterDatasetsDraw(chart) {
      if (!chart.canvas.closest('.timeline')) return;
      const {ctx, chartArea: area, scales: {x}} = chart;
      const inside = (at) => Math.min(Math.max(at, area.left), area.right);
      ctx.save();
      if (shared.from !== null) {
        const [a, b] = [inside(x.getPixelForValue(shared.from)), inside(x.getPixelForValue(shared.to))];
        ctx.globalAlpha = 0.15;
        ctx.fillStyle = colour('blue');
        ctx.fillRect(Math.min(a, b), area.top, Math.abs(b - a), area.bottom - area.top);
      } else if (shared.cursor !== null) {
        const at = x.getPixelForValue(shared.cursor);
        if (at >= area.left && at <= area.right) {
          ctx.strokeStyle = colour('grey');
          ctx.beginPath();
          ctx.moveTo(at, area.top);
          ctx.lineTo(at, area.bottom);
          ctx.stroke();
        }
      }
      ctx.restore();
    }
  };

  // Building blocks ----------------------------------------------------------------------------------------------------
  const points = (xs, ys) => xs.map((x, i) => ({x, y: ys[i]}));
  const series = (label, name, values, more = {}) => ({
    label, data: values, borderColor: colour(name), backgroundColor: colour(name), borderWidth: 1.5, pointRadius: 0,
    pointHitRadius: 6, ...more
  });
  const logMicro = (title, more = {}) => axis(title, {
    type: 'logarithmic', ticks: {callback: (value) => decade(value) ? micro(value) : ''}, ...more
  });
  const timeAxis = () => axis('time since the start, s', {
    type: 'linear', min: 0, max: data.end_s, offset: false, grid: {color: colour('grid'), drawBorder: false, offset: false},
    ticks: {callback: (value) => trim(value, 5)}
  });
  // So that the time lines stand exactly below each other, whether they have an axis on the right or not.
  const sameWidth = (scale) => { scale.width = 72; };
  const rightEdge = 52;
  const sameRightWidth = (scale) => { scale.width = rightEdge; };

  function draw(id, config, readable) {
    const canvas = document.getElementById(id);
    if (!canvas) return;
    const {plugins = {}, ...rest} = config.options || {};
    charts.push(new Chart(canvas, {
      type: config.type || 'line', data: {datasets: config.datasets}, plugins: [limits, timeWindow],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, parsing: false, normalized: true,
        interaction: {mode: 'index', axis: 'x', intersect: false}, ...rest,
        plugins: {
          legend: {labels: {color: colour('ink'), boxWidth: 14, boxHeight: 3, usePointStyle: false}},
          tooltip: {callbacks: readable || {}}, ...plugins
        }
      }
    }));
  }

  // The charts -------------------------------------------------------------------------------------------------------
  const period = {at: data.period_us, label: 'period ' + micro(data.period_us)};
  const budget = data.budget_us == null ? [] : [{at: data.budget_us, label: 'budget ' + micro(data.budget_us)}];
  const net = (make) => data.stalls_measured ? [make()] : [];  // in simulated time nothing is net of stalls
  const asMicro = (item) => item.dataset.label + ': ' + micro(item.parsed.y, 4);
  const atTime = (items) => items.length ? items[0].parsed.x.toFixed(3) + ' s' : '';

  function drawCurve() {
    const curve = (label, name, key, dash) =>
      series(label, name, data.curves[key].map(([x, y]) => ({x, y})), {borderDash: dash, borderWidth: 2});
    draw('chart-curve', {
      datasets: [curve('tick', 'blue', 'tick'), curve('wake-up', 'orange', 'wake', [7, 3]),
        curve('query, gross', 'purple', 'gross', [2, 3]), ...net(() => curve('query, net', 'green', 'net'))],
      options: {
        scales: {
          x: axis('percentile of the samples', {
            type: 'logarithmic', min: 1, ticks: {callback: (value) => decade(value) ? percentile(value) : ''}
          }),
          y: logMicro('latency')
        },
        interaction: {mode: 'nearest', axis: 'x', intersect: false},
        plugins: {limits: {lines: [period, ...budget]}}
      }
    }, {title: (items) => items.length ? percentile(items[0].parsed.x) : '', label: asMicro});
  }

  function drawBars() {
    const edges = data.bars.from_us;
    const bars = (label, name, key, more) => series(label, name,
      edges.map((x, i) => ({x, y: Math.max(data.bars[key][i], 0.5)})).concat(
        edges.length ? [{x: edges[edges.length - 1] * 10 ** 0.05, y: 0.5}] : []),
      {stepped: true, ...more});
    draw('chart-bars', {
      datasets: [bars('tick', 'blue', 'tick'), bars('wake-up', 'orange', 'wake', {borderDash: [7, 3]}),
        bars(data.stalls_measured ? 'query, net' : 'query', 'green', 'net')],
      options: {
        scales: {
          x: logMicro('latency'),
          y: axis('samples per bin', {type: 'logarithmic', min: 0.5, ticks: {callback: (v) => decade(v) ? v.toLocaleString('en') : ''}})
        },
        plugins: {limits: {lines: [{...period, axis: 'x'}, ...budget.map((b) => ({...b, axis: 'x'}))]}}
      }
    }, {
      title: (items) => items.length ? micro(items[0].parsed.x) + ' to ' + micro(items[0].parsed.x * 10 ** 0.05) : '',
      label: (item) => item.dataset.label + ': ' + (item.parsed.y < 1 ? 0 : item.parsed.y)
    });
  }

  function drawTimeLine(id, yAxis, datasets, lines = [], label = asMicro, more = {}) {
    draw(id, {
      datasets, type: more.type, options: {
        layout: {padding: {right: more.scales ? 0 : rightEdge}},
        scales: {x: timeAxis(), y: {...yAxis, afterFit: sameWidth}, ...(more.scales || {})}, plugins: {limits: {lines}}
      }
    }, {title: atTime, label});
  }

  function drawTimes() {
    drawTimeLine('chart-latency', logMicro('latency'), [
      series('tick', 'blue', points(time.t, time.tick)), series('wake-up', 'orange', points(time.t, time.wake))], [period]);
    drawTimeLine('chart-query', logMicro('time in queries'), [
      ...net(() => series('net', 'green', points(time.t, time.net))), series('gross', 'purple', points(time.t, time.gross)),
      ...net(() => series('stalls', 'ink', points(time.t, time.stall.map((us) => us > 0 ? us : null)),
        {showLine: false, pointRadius: 3, pointStyle: 'crossRot'}))], budget);
    drawTimeLine('chart-missed', axis('periods', {beginAtZero: true, ticks: {precision: 0}}), [
      series('late', 'orange', points(time.t, time.late), {barThickness: 4, grouped: false}),
      series('skipped', 'red', points(time.t, time.skipped), {barThickness: 4, grouped: false})], [],
      (item) => item.dataset.label + ': ' + item.parsed.y, {type: 'bar'});
  }

  function drawAnswers() {
    const total = time.t.map((_, i) => time.proved[i] + time.estimated[i] + time.budget[i] + time.none[i]);
    // Each area reaches down to the axis and hides the lower part of the next: areas side by side would leave seams.
    let below = time.t.map(() => 0);
    const share = (label, name, key) => {
      below = below.map((sum, i) => sum + time[key][i]);
      return series(label, name, time.t.map((x, i) => ({x, y: 100 * below[i] / total[i], own: 100 * time[key][i] / total[i]})),
        {fill: 'origin', borderWidth: 0, stepped: true});
    };
    drawTimeLine('chart-answers', axis('share of the ticks, %', {min: 0, max: 100}), [
      share('proved', 'green', 'proved'), share('estimated', 'sky', 'estimated'), share('at the budget', 'orange', 'budget'),
      share('no query needed', 'rule', 'none')], [], (item) => item.dataset.label + ': ' + trim(item.raw.own, 3) + ' %');
    drawTimeLine('chart-doubt', axis('chance of error', {min: 0, suggestedMax: 0.5}), [
      series('chance that an unproved verdict is wrong', 'purple', points(time.t, time.undecided),
        {showLine: false, pointRadius: 1.6})], [], (item) => trim(item.parsed.y, 3));
  }

  function drawForces() {
    const unit = (name) => (item) => item.dataset.label + ': ' + trim(item.parsed.y, 3) + ' ' + name;
    const vector = (key) => [
      series('x', 'blue', points(time.t, time[key + '_x'])), series('y', 'orange', points(time.t, time[key + '_y'])),
      series('z', 'green', points(time.t, time[key + '_z'])),
      series('size', 'ink', points(time.t, time[key]), {borderWidth: 1, borderDash: [3, 3]})];
    drawTimeLine('chart-force', axis('force, N'), vector('force'), [], unit('N'));
    drawTimeLine('chart-torque', axis('torque, N·m'), vector('torque'), [], unit('N·m'));
    drawTimeLine('chart-energy', axis('energy, J'), [series('taken in at the hand', 'purple', points(time.t, time.energy))]);
    drawTimeLine('chart-contact', axis('depth, mm', {beginAtZero: true}), [
      series('deepest contact', 'blue', points(time.t, time.depth)),
      series('contact points', 'orange', points(time.t, time.contacts), {yAxisID: 'count', stepped: true, borderWidth: 0.8})], [],
      (item) => item.dataset.label + ': ' + trim(item.parsed.y, 3) + (item.datasetIndex === 0 ? ' mm' : ''),
      {scales: {count: axis('contact points', {
        position: 'right', beginAtZero: true, grid: {display: false}, ticks: {precision: 0}, afterFit: sameRightWidth
      })}});
  }

  page.show(() => {
    drawCurve();
    drawBars();
    drawTimes();
    drawAnswers();
    drawForces();
  });
})();
