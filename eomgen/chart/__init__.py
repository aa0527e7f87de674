"""Speed against accuracy: every formulation, integrator, step and precision of one scene."""
