"""C²Nav, headless: a frozen vision-language model orders alternatives that the controller built."""
