// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The words of the page, in English, German, French and Japanese. */

export const LANGUAGES = ["en", "de", "fr", "ja"];

/** @type {Record<string, string[]>} a word in each language */
const WORDS = {
  model: ["Model", "Modell", "Modèle", "モデル"],
  coordinates: ["{0} coordinates", "{0} Koordinaten", "{0} coordonnées", "{0} 座標"],
  trees: ["Trees", "Bäume", "Arbres", "樹木"],
  segments: ["Segments", "Segmente", "Segments", "節数"],
  steps: ["Steps", "Schritte", "Pas", "計算"],
  latency: ["Latency", "Verzug", "Latence", "遅延"],
  stream: ["Stream", "Datenstrom", "Flux", "通信"],
  drawn: ["Drawn", "Gezeichnet", "Affichage", "描画"],
  wind: ["Wind", "Wind", "Vent", "風速"],
  motion: ["Motion of the tip", "Auslenkung der Spitze", "Mouvement de la cime", "先端の変位"],
  strain: ["Strain at the base", "Dehnung am Ansatz", "Déformation à la base", "基部のひずみ"],
  tallest: ["highest branch", "höchster Ast", "branche la plus haute", "最も高い枝"],
  gust: ["mean {0}, gust {1} m/s", "Mittel {0}, Böe {1} m/s", "moyenne {0}, rafale {1} m/s", "平均 {0}、最大 {1} m/s"],
  from: ["from {0}", "aus {0}", "de {0}", "{0}から"],
  points: ["N NE E SE S SW W NW", "N NO O SO S SW W NW", "N NE E SE S SO O NO", "北 北東 東 南東 南 南西 西 北西"],
  controls: ["Controls", "Steuerung", "Réglages", "操作"],
  mean_speed: ["Wind", "Wind", "Vent", "風速"],
  intensity: ["Gustiness", "Böigkeit", "Turbulence", "乱れ"],
  bearing_to: ["Wind from", "Wind aus", "Vent de", "風向"],
  tolerance: ["Tolerance", "Toleranz", "Tolérance", "許容誤差"],
  damping_ratio: ["Damping", "Dämpfung", "Amortissement", "減衰"],
  tree: ["Tree", "Baum", "Arbre", "樹木"],
  count: ["Stand of", "Bestand von", "Peuplement de", "本数"],
  pause: ["Pause", "Anhalten", "Pause", "一時停止"],
  reset: ["Reset", "Zurücksetzen", "Remettre", "リセット"],
  home: ["See all of the tree (0)", "Ganzen Baum zeigen (0)", "Voir tout l’arbre (0)", "全体を表示 (0)"],
  leaves: ["Leaves (L)", "Blätter (L)", "Feuilles (L)", "葉 (L)"],
  bare: ["No leaves: this tree is solved bare", "Keine Blätter: kahl gerechnet", "Sans feuilles : calculé nu", "葉なしで計算"],
  theme: ["Day, evening, night (T)", "Tag, Abend, Nacht (T)", "Jour, soir, nuit (T)", "昼・夕・夜 (T)"],
  season: ["Summer or autumn (A)", "Sommer oder Herbst (A)", "Été ou automne (A)", "夏・秋 (A)"],
  picture: ["Save a picture (P)", "Bild speichern (P)", "Enregistrer l’image (P)", "画像を保存 (P)"],
  link: ["Copy a link to this view (K)", "Link zu dieser Ansicht kopieren (K)", "Copier le lien de la vue (K)", "この視点のリンクをコピー (K)"],
  full: ["Full screen (F)", "Vollbild (F)", "Plein écran (F)", "全画面 (F)"],
  help: ["Help (?)", "Hilfe (?)", "Aide (?)", "ヘルプ (?)"],
  close: ["Close", "Schließen", "Fermer", "閉じる"],
  copied: ["Link copied", "Link kopiert", "Lien copié", "リンクをコピーしました"],
  language: ["Language", "Sprache", "Langue", "言語"],
  keys: [
    "Drag or arrow keys: turn|Shift + arrow keys, right button: move|Wheel, + and −: zoom|0: see all|Click, [ and ]: pick a branch, Esc: none|L: leaves|T: day, evening, night|A: autumn|M: somebody for scale|P: save a picture|K: copy a link|F: full screen|Space: pause",
    "Ziehen oder Pfeiltasten: drehen|Umschalt + Pfeile, rechte Taste: verschieben|Rad, + und −: näher, ferner|0: alles zeigen|Klick, [ und ]: Ast wählen, Esc: keiner|L: Blätter|T: Tag, Abend, Nacht|A: Herbst|M: Mensch als Maßstab|P: Bild speichern|K: Link kopieren|F: Vollbild|Leertaste: anhalten",
    "Glisser ou flèches : tourner|Maj + flèches, bouton droit : déplacer|Molette, + et − : zoom|0 : tout voir|Clic, [ et ] : choisir une branche, Échap : aucune|L : feuilles|T : jour, soir, nuit|A : automne|M : personne pour l’échelle|P : enregistrer l’image|K : copier le lien|F : plein écran|Espace : pause",
    "ドラッグ・矢印キー：回転|Shift＋矢印・右ボタン：移動|ホイール・＋・−：拡大縮小|0：全体|クリック・[・]：枝を選ぶ、Esc：解除|L：葉|T：昼・夕・夜|A：秋|M：人物|P：画像を保存|K：リンク|F：全画面|スペース：一時停止",
  ],
  live: ["Live", "Live", "En direct", "ライブ"],
  paused: ["Paused", "Angehalten", "En pause", "停止中"],
  connecting: ["Connecting", "Verbinde", "Connexion", "接続中"],
  seeking: ["Looking for the solver.", "Suche den Löser.", "Recherche du solveur.", "計算サーバーを探しています。"],
  lost: ["Connection lost", "Verbindung verloren", "Connexion perdue", "接続が切れました"],
  again: ["Trying again in {0} s.", "Neuer Versuch in {0} s.", "Nouvel essai dans {0} s.", "{0} 秒後に再接続します。"],
  retry: ["Try now", "Jetzt versuchen", "Essayer", "今すぐ再接続"],
  empty: ["No tree yet", "Noch kein Baum", "Pas encore d’arbre", "樹木がありません"],
  soon: ["The server has not described one. It will appear here.", "Der Server hat noch keinen beschrieben. Er erscheint hier.", "Le serveur n’en a pas encore décrit. Il apparaîtra ici.", "サーバーからの送信を待っています。"],
  behind: ["Behind by {0} s", "{0} s zurück", "En retard de {0} s", "{0} 秒遅れ"],
  waiting: ["Waiting for motion", "Warte auf Bewegung", "En attente de mouvement", "動きを待っています"],
  building: ["Building…", "Baue auf…", "Construction…", "構築中…"],
  blind: ["This browser cannot draw the tree", "Dieser Browser kann den Baum nicht zeichnen", "Ce navigateur ne peut pas dessiner l’arbre", "このブラウザーでは描画できません"],
  cure: [
    "{0}. Turn on hardware acceleration in the browser's settings, or take Chrome 56, Firefox 51, Safari 15 or later; without a graphics unit start Chrome with --enable-unsafe-swiftshader.",
    "{0}. Hardwarebeschleunigung in den Einstellungen des Browsers einschalten, oder Chrome ab 56, Firefox ab 51, Safari ab 15; ohne Grafikeinheit Chrome mit --enable-unsafe-swiftshader starten.",
    "{0}. Activez l’accélération matérielle du navigateur, ou prenez Chrome 56, Firefox 51, Safari 15 ou plus récent ; sans carte graphique, lancez Chrome avec --enable-unsafe-swiftshader.",
    "{0}。ブラウザー設定でハードウェアアクセラレーションを有効にするか、Chrome 56、Firefox 51、Safari 15 以降を使ってください。GPU がない場合は Chrome を --enable-unsafe-swiftshader 付きで起動してください。",
  ],
  corrected: [
    "Solved here by the wind: {0} corrections, of {1} % of full scale at most",
    "Hier gerechnet, nur Wind kommt: {0} Korrekturen, höchstens {1} % des Endwerts",
    "Calculé ici à partir du vent : {0} corrections, au plus {1} % de la pleine échelle",
    "風だけを受信して計算：補正 {0} 回、最大 {1} %",
  ],
  damaged: ["This file is damaged", "Diese Datei ist beschädigt", "Ce fichier est endommagé", "ファイルが壊れています"],
  write_again: [
    "{0}. Get it again from where it came, or write it again with tree-sway convert.",
    "{0}. Bitte erneut herunterladen oder mit tree-sway convert neu schreiben.",
    "{0}. Téléchargez-le à nouveau, ou réécrivez-le avec tree-sway convert.",
    "{0}。もう一度入手するか、tree-sway convert で書き直してください。",
  ],
  left_out: [
    "Without a graphics unit: {0} % of the pixels, {1} % of the leaves",
    "Ohne Grafikeinheit: {0} % der Bildpunkte, {1} % der Blätter",
    "Sans carte graphique : {0} % des pixels, {1} % des feuilles",
    "GPU なし：画素 {0} %、葉 {1} %",
  ],
};

let chosen = Math.max(0, LANGUAGES.indexOf(navigator.language.slice(0, 2)));

/** @param {string} language */
export function setLanguage(language) {
  chosen = Math.max(0, LANGUAGES.indexOf(language));
  document.documentElement.lang = LANGUAGES[chosen];
  for (const each of document.querySelectorAll("[data-word]")) {
    const text = word(/** @type {HTMLElement} */ (each).dataset.word ?? "");
    if (each.matches("#tools button")) {
      each.setAttribute("title", text);
      each.setAttribute("aria-label", text);
    } else each.textContent = text;
  }
}

export function language() {
  return LANGUAGES[chosen];
}

/** A word in the language that is chosen; the key where there is none.
 * @param {string} key @param {...(string | number)} values in place of {0}, {1} */
export function word(key, ...values) {
  const text = WORDS[key]?.[chosen] ?? key;
  return text.replace(/\{(\d)\}/g, (_, i) => String(values[i]));
}

/** Whether there is a word of a key. @param {string} key */
export function hasWord(key) {
  return key in WORDS;
}

/** Where a wind comes from, as people say it: the one convention of the page.
 * @param {number} x it blows to, east [m/s] @param {number} y north */
export function windFrom(x, y) {
  if (Math.hypot(x, y) < 0.05) return "";
  const degrees = (((Math.atan2(-x, -y) * 180) / Math.PI) + 360) % 360;
  return word("from", `${word("points").split(" ")[Math.round(degrees / 45) % 8]} (${Math.round(degrees)}°)`);
}
