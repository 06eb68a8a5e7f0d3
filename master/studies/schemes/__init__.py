"""Coupling schemes beside each other on one scene: error, order and cost by macro step."""
