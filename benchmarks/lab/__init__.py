"""Everything `benchmarks/engine.py` runs: scenes, our peers, and how they are timed."""
