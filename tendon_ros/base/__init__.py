"""What every other layer stands on: errors, parameters, recordings and the effect contract."""
