"""What constraints leave free: admissible states, rank, integrability, a card for each."""
