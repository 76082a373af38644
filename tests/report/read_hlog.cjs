// Reads an interval log with an independent implementation (npm package hdr-histogram-js) and prints what it understood:
// `node read_hlog.cjs LOG` figures as JSON, `--hgrm` the first interval as percentile table, `--encode` each interval
// written anew by that implementation, one base64 text a line. Exit status 77 if the package is not installed.
'use strict';
const fs = require('fs');
let hdr;
try {
  hdr = require(require.resolve('hdr-histogram-js', {paths: (process.env.NODE_PATH || '').split(':').concat(process.cwd())}));
} catch (missing) {
  console.error('hdr-histogram-js is not installed');
  process.exit(77);
}

const [log, mode] = process.argv.slice(2);
const intervals = fs.readFileSync(log, 'utf8').split('\n').filter((line) => line && line[0] !== '#' && line[0] !== '"')
  .map((line) => {
    const fields = line.split(',');
    const tag = fields[0].startsWith('Tag=') ? fields.shift().slice(4) : '';
    return {tag, start: Number(fields[0]), length: Number(fields[1]), histogram: hdr.decodeFromCompressedBase64(fields[3])};
  });

if (mode === '--hgrm') {
  process.stdout.write(intervals[0].histogram.outputPercentileDistribution(5, 1000));
} else if (mode === '--encode') {
  for (const {histogram} of intervals) console.log(hdr.encodeIntoCompressedBase64(histogram));
} else {
  console.log(JSON.stringify(intervals.map(({tag, start, length, histogram}) => ({
    tag, start, length, count: histogram.totalCount, max: histogram.maxValue, mean: histogram.mean,
    percentiles: [0, 10, 50, 90, 99, 99.9, 99.99, 100].map((p) => [p, histogram.getValueAtPercentile(p)])
  })), null, 1));
}
