// Rows of CSV (RFC 4180), as the program writes them.

// Text that a spreadsheet would take for a formula is marked as text: names come from a map that anybody edits.
export function csvCell(value) {
  if (value === null || value === undefined) return '';
  const text = typeof value === 'string' && /^[=+\-@\t\r]/.test(value) ? `'${value}` : String(value);
  return /[",\r\n]/.test(text) || text.startsWith("'") ? `"${text.replaceAll('"', '""')}"` : text;
}

export const csvRow = (values) => `${values.map(csvCell).join(',')}\n`;
