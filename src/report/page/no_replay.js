// No library for three dimensions was found at build time.
