"""An operator alone whose drive is limited."""
