// Stands in for the chart library where none was found at build time.
