"""What the studio does, without a page: files, records, models, commands."""
