"""What measures and shows the engine: benchmarks, figures, calibration. Only commands import it."""
